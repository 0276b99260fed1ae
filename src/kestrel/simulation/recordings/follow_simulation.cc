// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/follow_simulation.h"

#include <cmath>
#include <memory>
#include <utility>

#include "kestrel/core/base/hash.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/recordings/follow_truth.h"
#include "kestrel/simulation/recordings/second_camera.h"
#include "kestrel/simulation/recordings/truth_text.h"
#include "kestrel/simulation/scene/direction.h"
#include "kestrel/simulation/vehicle/flight_time.h"
#include "kestrel/simulation/vehicle/multicopter_motion.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Each part has its own random numbers: options of one part do not change another.
enum class RecordingPart { kMotion = 400, kFlight, kLost };
Random RandomOf(std::uint64_t seed, RecordingPart part) {
  return Random(Hash(seed, static_cast<std::uint64_t>(part)));
}

Path BesidePath(const FollowFlightOptions& options, const Motion& thing, Random* random) {
  constexpr double kSwing_s = 20, kWave_s = 6, kWave_m = 0.2;
  const double bearing = random->Uniform(0, 2 * kPi);
  const auto swing = Wander(Radians(options.swing_deg), kSwing_s, random);
  const auto wave = Wander(kWave_m, kWave_s, random);
  return [=](double time_s) {
    const Vector3d place = thing(time_s).translation;
    const Vector2d beside = options.distance_m * Direction(bearing + swing(time_s));
    return Vector3d(place.x() + beside.x(), place.y() + beside.y(),
                    options.height_m + wave(time_s));
  };
}

Motion UavMotion(const FollowFlightOptions& options, const Path& path, const Motion& thing,
                 Random* random) {
  constexpr double kWander_s = 4;
  const auto wander = Wander(Radians(1), kWander_s, random);
  const double swing = Radians(options.turn_deg), rate = options.turn_dps / options.turn_deg;
  const auto yaw = [=](double time_s) {
    const Vector3d way = thing(time_s).translation - path(time_s);
    const double past = options.turn_dps > 0 ? swing * std::sin(rate * time_s) : 0;
    return std::atan2(way.y(), way.x()) + past + wander(time_s);
  };
  return MulticopterMotion(path, yaw, options.attitude_noise_deg, random);
}

// Returns the indices of the images that are not lost; the first one never is.
std::vector<std::size_t> Kept(std::size_t count, double lost, Random* random) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < count; ++i) {
    if (!random->Chance(lost) || i == 0) kept.push_back(i);
  }
  return kept;
}

}  // namespace

FollowSimulationOptions::FollowSimulationOptions() {
  recording.frames = 240;
  recording.rate_hz = 20;
  recording.shutter = {.exposure_s = 0.004, .readout_s = 0.02, .rays_per_pixel = 3};
  recording.sensor.gain_variation = 0.05;
  recording.sensor.gamma = 0.5;
  motion.path = "stops";
  motion.speed_mps = 1.6;
  surroundings.ground.map_px = 2048;
}

std::vector<std::string> FollowSimulationOptions::Validate() const {
  std::vector<std::string> violations;
  if (!thing.is_there()) violations.emplace_back("thing.kind is 'none', expected a thing");
  if (thing.cover != "none" && (motion.path == "standing" || motion.speed_mps <= 0)) {
    violations.emplace_back("thing.cover: expected a thing that moves");
  }
  RequireFixedLens(recording.zoom, &violations);
  return violations;
}

CameraCalibration FollowCalibration() { return SecondCalibration(70, 56); }

RecordingPlan PlanFollow(const FollowSimulationOptions& options, const CameraCalibration& camera,
                         std::uint64_t seed) {
  RequireValid(options);
  Random motion_random = RandomOf(seed, RecordingPart::kMotion);
  const Motion thing = VehicleMotion(options.motion, &motion_random);
  Random flight_random = RandomOf(seed, RecordingPart::kFlight);
  const Path path = BesidePath(options.flight, thing, &flight_random);
  const Motion world_from_uav = UavMotion(options.flight, path, thing, &flight_random);
  FollowScene scene =
      MakeFollowScene(options.thing, options.surroundings, thing, path, /*channels=*/3, seed);
  const std::vector<int> lookalikes = scene.lookalikes;
  const Path target = [thing](double time_s) { return thing(time_s).translation; };
  const auto flight = std::make_shared<SimulatedFlight>(
      options.recording, camera, Drawing(), std::move(scene.world), world_from_uav, target, seed);
  Random lost_random = RandomOf(seed, RecordingPart::kLost);
  const std::vector<std::size_t> kept =
      Kept(flight->times_s().size(), options.lost_frames, &lost_random);
  std::vector<double> times_s;
  for (const std::size_t i : kept) times_s.push_back(flight->times_s()[i]);
  RecordingPlan plan;
  for (const double time_s : times_s) plan.times.push_back(TimeOfFlight(time_s));
  plan.render = [flight, kept](std::size_t i) { return flight->Image(kept[i]); };
  plan.scene = flight->SceneText("follow") + "options:\n" + Indented(PrintOptions(options));
  plan.files = flight->Files();
  plan.files.push_back({RegionTruthFile(0), RegionRowsText(scene.thing, *flight, times_s)});
  for (std::size_t i = 0; i < lookalikes.size(); ++i) {
    plan.files.push_back({RegionTruthFile(i + 1), RegionRowsText(lookalikes[i], *flight, times_s)});
  }
  return plan;
}

}  // namespace kestrel
