// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/landing_simulation.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "kestrel/base/options.h"
#include "kestrel/simulation/landing_scene.h"
#include "kestrel/simulation/landing_stills.h"
#include "kestrel/simulation/simulated_flight.h"
#include "kestrel/simulation/truth_text.h"
#include "kestrel/simulation/violations.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

// A flight and what it flies over.
struct LandingFlightTruth {
  LandingPattern pattern;
  Motion world_from_pattern;
  std::unique_ptr<SimulatedFlight> flight;
};

std::string TruthRow(const LandingFlightTruth& truth, double time_s) {
  const FlightCamera& camera = truth.flight->camera();
  const RigidTransform pattern = truth.world_from_pattern(time_s);
  const RigidTransform pattern_from_camera = pattern.Inverse() * camera.WorldFromCamera(time_s);
  const auto pixel = camera.Project(time_s, [&truth](double row_time_s) {
    return truth.world_from_pattern(row_time_s).translation;
  });
  if (!pixel) return "";
  const Vector3d& p = pattern.translation;
  const Eigen::Quaterniond& q = pattern.rotation;
  const Vector3d v = VelocityOf(truth.world_from_pattern, time_s);
  const double visible =
      VisibleFraction(truth.pattern, pattern_from_camera.Inverse(), camera.lens());
  return fmt::format(
      "{},{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f},{:.6f},{:.6f},{:.6f},"
      "{:.4f},{:.4f},{:.6f},{:.4f}\n",
      ToNanoseconds(TimeOfFlight(time_s)), p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), v.x(),
      v.y(), v.z(), pixel->x(), pixel->y(), pattern_from_camera.translation.z(), visible);
}

std::string TruthText(const LandingFlightTruth& truth) {
  std::string text = LandingTruthHeader();
  for (const double time_s : truth.flight->times_s()) text += TruthRow(truth, time_s);
  return text;
}

// No UAV sinks faster than about 10 m/s: whoever asks for fewer images has to say what else
// changes.
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

}  // namespace

std::vector<std::string> BoardOptions::Validate() const {
  std::vector<std::string> violations;
  if (carrier != "pickup" && carrier != "car" && carrier != "box") {
    violations.push_back(fmt::format("carrier is '{}', expected pickup, car or box", carrier));
  }
  RequireIn(border_m, 0, 1, "border_m", &violations);
  RequireIn(arm_variation_m, 0, 0.2, "arm_variation_m", &violations);
  RequireIn(dirt, 0, 1, "dirt", &violations);
  RequireIn(scratches, 0, 200, "scratches", &violations);
  RequireIn(gloss, 0, 10, "gloss", &violations);
  RequireIn(gloss_width_deg, 1, 90, "gloss_width_deg", &violations);
  return violations;
}

std::vector<std::string> SurroundingsOptions::Validate() const {
  std::vector<std::string> violations;
  RequireIn(vehicles, 0, 100, "vehicles", &violations);
  RequireIn(lookalikes, 0, 100, "lookalikes", &violations);
  RequireIn(banners, 0, 100, "banners", &violations);
  return violations;
}

std::vector<std::string> LandingSimulationOptions::Validate() const {
  std::vector<std::string> violations = recording.Validate();
  AddViolations("stills", stills.Validate(), &violations);
  AddViolations("vehicle", vehicle.Validate(), &violations);
  AddViolations("flight", flight.Validate(), &violations);
  AddViolations("pattern", pattern.Validate(), &violations);
  AddViolations("board", board.Validate(), &violations);
  AddViolations("ground", ground.Validate(), &violations);
  AddViolations("surroundings", surroundings.Validate(), &violations);
  AddViolations("light", light.Validate(), &violations);
  const bool flies = stills.show == "nothing";
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
  LandingScene scene = MakeLandingScene(options, /*channels=*/1, seed);
  const Drawing airframe =
      options.surroundings.landing_legs ? LandingLegs(camera.intrinsics, /*four=*/true) : Drawing();
  const auto truth = std::make_shared<LandingFlightTruth>();
  truth->pattern = scene.pattern;
  truth->world_from_pattern = scene.world_from_pattern;
  truth->flight = std::make_unique<SimulatedFlight>(
      recording, camera, airframe, std::move(scene.world), scene.world_from_uav, seed);

  RecordingPlan plan;
  for (const double time_s : truth->flight->times_s()) plan.times.push_back(TimeOfFlight(time_s));
  plan.render = [truth](std::size_t i) { return truth->flight->Image(i); };
  plan.scene = truth->flight->SceneText("landing") +
               fmt::format("drawn_arm_half_length_m: {}\n", truth->pattern.arm_half_length_m) +
               "options:\n" + Indented(PrintOptions(options));
  plan.files = truth->flight->Files();
  plan.files.push_back({"landing_pattern0/data.csv", TruthText(*truth)});
  return plan;
}

}  // namespace kestrel
