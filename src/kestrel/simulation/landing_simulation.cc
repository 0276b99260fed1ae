// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/landing_simulation.h"

#include <memory>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "kestrel/base/options.h"
#include "kestrel/recording/euroc_text.h"
#include "kestrel/simulation/flight_camera.h"
#include "kestrel/simulation/hash.h"
#include "kestrel/simulation/landing_scene.h"
#include "kestrel/simulation/landing_stills.h"
#include "kestrel/simulation/truth_text.h"
#include "kestrel/simulation/violations.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

// The navigation's poses begin before the first image and end after the last, whatever the offset.
constexpr double kMargin_s = 0.5;

// Seeds of what is drawn outside of the scene.
enum class Part { kNavigationErrors = 100, kPoses, kVibration, kGain, kNoise };
std::uint64_t SeedOf(std::uint64_t seed, Part part) {
  return Hash(seed, static_cast<std::uint64_t>(part));
}

// All that the images are made of, kept together.
struct LandingFlightState {
  LandingScene scene;
  std::unique_ptr<FlightCamera> camera;
  std::vector<double> times_s;
  std::uint64_t noise_seed;
};

std::vector<double> ImageTimes(int frames, double rate_hz) {
  std::vector<double> times_s;
  for (int i = 0; i < frames; ++i) times_s.push_back(i / rate_hz);
  return times_s;
}

Motion CameraMotion(const Motion& world_from_body, const RigidTransform& body_from_camera,
                    const NavigationOptions& options, std::uint64_t seed) {
  Random random(seed);
  const auto vibration = Vibration(options, &random);
  return [=](double time_s) {
    return world_from_body(time_s) * body_from_camera *
           RigidTransform{vibration(time_s), Vector3d::Zero()};
  };
}

std::function<double(double)> GainControl(const SensorOptions& options, std::uint64_t seed) {
  Random random(seed);
  constexpr double kPeriod_s = 5;
  const auto wander = Wander(options.gain_variation, kPeriod_s, &random);
  return [=](double time_s) { return std::max(1 + wander(time_s), 0.1); };
}

LensOptions LensOf(const LandingSimulationOptions& options, const CameraIntrinsics& camera) {
  LensOptions lens;
  lens.half_angle_deg = options.lens.half_angle_deg;
  lens.vignette = options.lens.vignette;
  if (options.surroundings.landing_legs) lens.airframe = LandingLegs(camera, /*four=*/true);
  return lens;
}

std::string TruthRow(const LandingFlightState& state, double time_s) {
  const RigidTransform pattern = state.scene.world_from_pattern(time_s);
  const RigidTransform camera = state.camera->WorldFromCamera(time_s);
  const RigidTransform pattern_from_camera = pattern.Inverse() * camera;
  const auto pixel = state.camera->Project(time_s, [&](double row_time_s) {
    return state.scene.world_from_pattern(row_time_s).translation;
  });
  if (!pixel) return "";
  const Vector3d& p = pattern.translation;
  const Eigen::Quaterniond& q = pattern.rotation;
  const Vector3d v = VelocityOf(state.scene.world_from_pattern, time_s);
  const double visible =
      VisibleFraction(state.scene.pattern, pattern_from_camera.Inverse(), state.camera->lens());
  return fmt::format(
      "{},{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f},{:.6f},{:.6f},{:.6f},"
      "{:.4f},{:.4f},{:.6f},{:.4f}\n",
      ToNanoseconds(TimeOfFlight(time_s)), p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), v.x(),
      v.y(), v.z(), pixel->x(), pixel->y(), pattern_from_camera.translation.z(), visible);
}

std::string TruthText(const LandingFlightState& state) {
  std::string text = LandingTruthHeader();
  for (const double time_s : state.times_s) text += TruthRow(state, time_s);
  return text;
}

std::string SceneText(const LandingSimulationOptions& options, const CameraCalibration& camera,
                      const NavigationErrors& errors, const LandingFlightState& state,
                      std::uint64_t seed) {
  const Vector3d sun = state.scene.world.light.to_sun;
  std::string text = fmt::format(
      "kind: landing\n"
      "seed: {}\n"
      "image_timestamp: middle of the exposure (of the middle row)\n"
      "time_offset_s: {}  # t_nav = t_image + time_offset_s\n"
      "mount_error:  # R_BS_true = Rz(yaw) Ry(pitch) Rx(roll) R_BS_nominal, body frame\n"
      "  yaw_deg: {}\n  pitch_deg: {}\n  roll_deg: {}\n",
      seed, errors.clock_offset_s, errors.mount_yaw_deg, errors.mount_pitch_deg,
      errors.mount_roll_deg);
  text += "true_T_BS:\n" + EurocTransformText(errors.TrueMount(*camera.body_from_camera));
  text += fmt::format("drawn_arm_half_length_m: {}\nsun_direction: [{}, {}, {}]\n",
                      state.scene.pattern.arm_half_length_m, sun.x(), sun.y(), sun.z());
  return text + "options:\n" + Indented(PrintOptions(options)) + "camera:\n" +
         Indented(EurocCameraText(camera, options.rate_hz));
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
  std::vector<std::string> violations;
  RequireIn(frames, 1, 1e6, "frames", &violations);
  RequireIn(rate_hz, 0.1, 1000, "rate_hz", &violations);
  AddViolations("vehicle", vehicle.Validate(), &violations);
  AddViolations("flight", flight.Validate(), &violations);
  AddViolations("navigation", navigation.Validate(), &violations);
  AddViolations("pattern", pattern.Validate(), &violations);
  AddViolations("stills", stills.Validate(), &violations);
  AddViolations("board", board.Validate(), &violations);
  AddViolations("ground", ground.Validate(), &violations);
  AddViolations("surroundings", surroundings.Validate(), &violations);
  AddViolations("light", light.Validate(), &violations);
  AddViolations("lens", lens.Validate(), &violations);
  AddViolations("shutter", shutter.Validate(), &violations);
  AddViolations("sensor", sensor.Validate(), &violations);
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
  if (options.stills.show != "nothing") {
    return PlanStills(options.stills, options.pattern, options.frames, options.lens.half_angle_deg,
                      camera, seed);
  }
  const auto state = std::make_shared<LandingFlightState>();
  state->scene = MakeLandingScene(options, /*channels=*/1, seed);
  state->times_s = ImageTimes(options.frames, options.rate_hz);
  state->noise_seed = SeedOf(seed, Part::kNoise);
  Random errors_random(SeedOf(seed, Part::kNavigationErrors));
  const NavigationErrors errors = DrawNavigationErrors(options.navigation, &errors_random);
  const Motion& body = state->scene.world_from_uav;
  state->camera = std::make_unique<FlightCamera>(
      CameraModel(camera.intrinsics), LensOf(options, camera.intrinsics), options.shutter,
      options.sensor, state->scene.world,
      CameraMotion(body, errors.TrueMount(*camera.body_from_camera), options.navigation,
                   SeedOf(seed, Part::kVibration)),
      GainControl(options.sensor, SeedOf(seed, Part::kGain)));

  RecordingPlan plan;
  for (const double time_s : state->times_s) plan.times.push_back(TimeOfFlight(time_s));
  plan.render = [state](std::size_t i) {
    return state->camera->Capture(state->times_s[i], Hash(state->noise_seed, i));
  };
  plan.scene = SceneText(options, camera, errors, *state, seed);
  const double end_s = state->times_s.back() + kMargin_s;
  Random pose_random(SeedOf(seed, Part::kPoses));
  const auto poses =
      ReportedPoses(options.navigation, errors, body, -kMargin_s, end_s, &pose_random);
  plan.files = {
      {"cam0/sensor.yaml", EurocCameraText(camera, options.rate_hz)},
      {"nav0/sensor.yaml", EurocPoseSensorText(options.navigation.rate_hz)},
      {"nav0/data.csv", EurocPoseText(poses)},
      {"state_groundtruth_estimate0/data.csv",
       TrueStateText(body, -kMargin_s, end_s, state->times_s)},
      {"landing_pattern0/data.csv", TruthText(*state)},
  };
  return plan;
}

}  // namespace kestrel
