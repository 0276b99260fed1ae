// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/landing_simulation.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "kestrel/core/base/options.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/simulation/labelled_images/landing_stills.h"
#include "kestrel/simulation/recordings/simulated_landing.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/vehicle/flight_time.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

// No UAV sinks faster than about 10 m/s: with fewer images other options have to change, too.
void RequireTime(const LandingFlightOptions& flight, double duration_s,
                 std::vector<std::string>* violations) {
  constexpr double kFastest_mps = 10;
  const double ratio = std::abs(std::log(flight.start_altitude_m / flight.end_altitude_m));
  const double least_s =
      std::max(flight.start_altitude_m, flight.end_altitude_m) * ratio / kFastest_mps;
  if (duration_s < least_s) {
    violations->push_back(
        fmt::format("frames / rate_hz is {:.2f} s, expected at least {:.2f} s for the way from {} "
                    "to {} m",
                    duration_s, least_s, flight.start_altitude_m, flight.end_altitude_m));
  }
}

void AddSecondCamera(const LandingSimulationOptions& options,
                     const std::shared_ptr<const SimulatedLanding>& landing,
                     const Motion& world_from_uav, std::uint64_t seed, RecordingPlan* plan) {
  const auto camera = std::make_shared<SecondCamera>(options.second, options.recording, *landing,
                                                     world_from_uav, seed);
  plan->scene += camera->SceneText();
  for (RecordingFile& file : camera->Files()) plan->files.push_back(std::move(file));
  plan->further.push_back(
      {camera->times(), [landing, camera](std::size_t i) { return camera->Image(i); }});
}

}  // namespace

std::vector<std::string> LandingSimulationOptions::Validate() const {
  std::vector<std::string> violations;
  const bool flies = stills.show == "nothing";
  if (!flies && second.is_there()) {
    violations.emplace_back("second.fov_deg is more than 0, expected 0 where stills are shown");
  }
  if (!flies && target.kind != TargetOptions().kind) {
    violations.push_back(fmt::format("target.kind is '{}', expected {} where stills are shown",
                                     target.kind, TargetOptions().kind));
  }
  if (flies && violations.empty()) RequireTime(flight, recording.duration_s(), &violations);
  return violations;
}

CameraCalibration PaperCalibration() {
  Eigen::Matrix3d axes;
  axes.col(0) = -Vector3d::UnitY();
  axes.col(1) = -Vector3d::UnitX();
  axes.col(2) = -Vector3d::UnitZ();
  CameraCalibration calibration;
  calibration.intrinsics = PaperCamera();
  calibration.body_from_camera = RigidTransform{Eigen::Quaterniond(axes), {0.13, 0, -0.05}};
  return calibration;
}

RecordingPlan PlanLanding(const LandingSimulationOptions& options, const CameraCalibration& camera,
                          std::uint64_t seed) {
  RequireValid(options);
  const FlightRecordingOptions& recording = options.recording;
  if (options.stills.show != "nothing") {
    return PlanStills(options.stills, options.pattern, recording.frames,
                      recording.lens.half_angle_deg, camera, seed);
  }
  LandingScene scene = MakeLandingScene(options, recording.duration_s(), /*channels=*/1, seed);
  Random random = RandomOf(seed, LandingPart::kFlight);
  const Motion world_from_uav =
      LandingFlight(options.flight, scene.target, recording.duration_s(), &random);
  const auto landing = std::make_shared<SimulatedLanding>(recording, options.surroundings, camera,
                                                          std::move(scene), world_from_uav, seed);
  RecordingPlan plan;
  for (const double time_s : landing->flight().times_s()) {
    plan.times.push_back(TimeOfFlight(time_s));
  }
  plan.render = [landing](std::size_t i) { return landing->flight().Image(i); };
  plan.scene = landing->SceneText("landing", PrintOptions(options));
  plan.files = landing->Files();
  if (options.second.is_there()) AddSecondCamera(options, landing, world_from_uav, seed, &plan);
  return plan;
}

}  // namespace kestrel
