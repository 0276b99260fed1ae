// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/simulated_flight.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/hash.h"
#include "kestrel/io/recording/euroc/euroc_layout.h"
#include "kestrel/io/recording/euroc/euroc_text.h"
#include "kestrel/simulation/recordings/truth_text.h"

namespace kestrel {
namespace {

// The poses begin before the first image and end after the last one, whatever the clock offset.
constexpr double kMargin_s = 0.5;

// Each part has its own random numbers.
enum class FlightPart { kErrors = 100, kPoses, kVibration, kGain, kNoise };
std::uint64_t SeedOf(std::uint64_t seed, FlightPart part) {
  return Hash(seed, static_cast<std::uint64_t>(part));
}
Random RandomOf(std::uint64_t seed, FlightPart part) { return Random(SeedOf(seed, part)); }

NavigationErrors ErrorsOf(const NavigationOptions& options, std::uint64_t seed) {
  Random random = RandomOf(seed, FlightPart::kErrors);
  return DrawNavigationErrors(options, &random);
}

Motion CameraMotion(const Motion& world_from_body, const RigidTransform& body_from_camera,
                    const NavigationOptions& options, std::uint64_t seed) {
  Random random = RandomOf(seed, FlightPart::kVibration);
  const auto vibration = Vibration(options, &random);
  return [=](double time_s) {
    return world_from_body(time_s) * body_from_camera *
           RigidTransform{vibration(time_s), Eigen::Vector3d::Zero()};
  };
}

std::function<double(double)> GainControl(const SensorOptions& options, std::uint64_t seed) {
  constexpr double kPeriod_s = 5;
  constexpr double kLeast = 0.1;
  Random random = RandomOf(seed, FlightPart::kGain);
  const auto wander = Wander(options.gain_variation, kPeriod_s, &random);
  return [=](double time_s) { return std::max(1 + wander(time_s), kLeast); };
}

}  // namespace

SimulatedFlight::SimulatedFlight(const FlightRecordingOptions& options,
                                 const CameraCalibration& camera, const Drawing& airframe,
                                 World world, Motion world_from_body, std::uint64_t seed)
    : options_(options),
      nominal_(camera),
      world_(std::move(world)),
      world_from_body_(std::move(world_from_body)),
      seed_(seed),
      errors_(ErrorsOf(options.navigation, seed)),
      gain_(GainControl(options.sensor, seed)) {
  for (int i = 0; i < options.frames; ++i) times_s_.push_back(i / options.rate_hz);
  LensOptions lens;
  lens.half_angle_deg = options.lens.half_angle_deg;
  lens.vignette = options.lens.vignette;
  lens.airframe = airframe;
  const Motion motion = CameraMotion(world_from_body_, errors_.TrueMount(*camera.body_from_camera),
                                     options.navigation, seed);
  camera_ = std::make_unique<FlightCamera>(CameraModel(camera.intrinsics), lens, options.shutter,
                                           options.sensor, world_, motion);
}

cv::Mat SimulatedFlight::Image(std::size_t index, double gain) const {
  const double time_s = times_s_[index];
  return camera_->Capture(time_s, gain * gain_(time_s),
                          Hash(SeedOf(seed_, FlightPart::kNoise), index));
}

void SimulatedFlight::EndBefore(std::size_t index) { times_s_.resize(index); }

NavigationSensor SimulatedFlight::navigation() const {
  return {options_.navigation, errors_, RandomOf(seed_, FlightPart::kPoses)};
}

double SimulatedFlight::begin_s() const { return -kMargin_s; }

std::string SimulatedFlight::SceneText(const std::string& kind) const {
  const Eigen::Vector3d& sun = world_.light.to_sun;
  return fmt::format(
      "kind: {}\n"
      "seed: {}\n"
      "image_timestamp: middle of the exposure (of the middle row)\n"
      "time_offset_s: {}  # t_nav = t_image + time_offset_s\n"
      "mount_error:  # R_BS_true = Rz(yaw) Ry(pitch) Rx(roll) R_BS_nominal, body frame\n"
      "  yaw_deg: {}\n  pitch_deg: {}\n  roll_deg: {}\n"
      "true_T_BS:\n{}"
      "sun_direction: [{}, {}, {}]\n"
      "camera:\n{}",
      kind, seed_, errors_.clock_offset_s, errors_.mount_yaw_deg, errors_.mount_pitch_deg,
      errors_.mount_roll_deg, EurocTransformText(errors_.TrueMount(*nominal_.body_from_camera)),
      sun.x(), sun.y(), sun.z(), Indented(EurocCameraText(nominal_, options_.rate_hz)));
}

std::vector<RecordingFile> SimulatedFlight::Files() const {
  const double end_s = times_s_.back() + kMargin_s;
  const auto poses = navigation().ReportAll(world_from_body_, begin_s(), end_s);
  return {{euroc::kCamera, EurocCameraText(nominal_, options_.rate_hz)},
          {euroc::kPoseSensor, EurocPoseSensorText(options_.navigation.rate_hz)},
          {euroc::kPoses, EurocPoseText(poses)},
          {euroc::kTruePoses, TrueStateText(world_from_body_, begin_s(), end_s, times_s_)}};
}

}  // namespace kestrel
