// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/second_camera.h"

#include <algorithm>

#include <fmt/format.h>

#include "kestrel/core/base/hash.h"
#include "kestrel/core/camera/assumed_lens.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/io/recording/euroc/euroc_text.h"
#include "kestrel/simulation/recordings/truth_text.h"
#include "kestrel/simulation/vehicle/flight_time.h"

namespace kestrel {
namespace {

constexpr double kPhase = 0.4;  // how much of its period it comes after the first camera
constexpr double kLate_s = 0.3;
constexpr double kTurned_deg = 5;

enum class SecondCameraPart { kErrors = 200, kVibration, kNoise };
std::uint64_t SeedOf(std::uint64_t seed, SecondCameraPart part) {
  return Hash(seed, static_cast<std::uint64_t>(part));
}

NavigationErrors SecondErrors(const NavigationOptions& options, std::uint64_t seed) {
  Random random(SeedOf(seed, SecondCameraPart::kErrors));
  return DrawNavigationErrors(options, &random);
}

Motion SecondMotion(const SecondCameraOptions& options, const NavigationOptions& navigation,
                    const RigidTransform& body_from_camera, const Motion& world_from_uav,
                    std::uint64_t seed) {
  Random random(SeedOf(seed, SecondCameraPart::kVibration));
  const auto vibration = Vibration(navigation, &random);
  const bool is_turned = options.fault == "mount";
  const Eigen::AngleAxisd turn(Radians(kTurned_deg), Eigen::Vector3d::UnitX());
  return [=](double time_s) {
    RigidTransform mount = body_from_camera;
    if (is_turned && time_s >= options.fault_at_s) mount.rotation = turn * mount.rotation;
    return world_from_uav(time_s) * mount *
           RigidTransform{vibration(time_s), Eigen::Vector3d::Zero()};
  };
}

LensOptions SecondLens(const FlightRecordingOptions& flight) {
  LensOptions lens;
  lens.half_angle_deg = flight.lens.half_angle_deg;
  lens.vignette = flight.lens.vignette;
  return lens;
}

}  // namespace

CameraCalibration SecondCalibration(double fov_deg, double tilt_deg) {
  constexpr int kWidth_px = 752, kHeight_px = 480;
  // Down, the top of the image ahead, then tilted up.
  Eigen::Matrix3d axes;
  axes.col(0) = -Eigen::Vector3d::UnitY();
  axes.col(1) = -Eigen::Vector3d::UnitX();
  axes.col(2) = -Eigen::Vector3d::UnitZ();
  const Eigen::AngleAxisd tilt(-Radians(tilt_deg), Eigen::Vector3d::UnitY());
  CameraCalibration calibration;
  calibration.intrinsics = AssumedLens(kWidth_px, kHeight_px, fov_deg);
  calibration.body_from_camera =
      RigidTransform{Eigen::Quaterniond(tilt * axes), Eigen::Vector3d(0.13, 0.06, -0.05)};
  return calibration;
}

SecondCamera::SecondCamera(const SecondCameraOptions& options, const FlightRecordingOptions& flight,
                           const SimulatedLanding& landing, const Motion& world_from_uav,
                           std::uint64_t seed)
    : options_(options),
      seed_(seed),
      landing_(landing),
      nominal_(SecondCalibration(options.fov_deg, options.tilt_deg)),
      errors_(SecondErrors(flight.navigation, seed)),
      camera_(CameraModel(nominal_.intrinsics), SecondLens(flight), flight.shutter, flight.sensor,
              landing.flight().world(),
              SecondMotion(options, flight.navigation,
                           errors_.TrueMount(*nominal_.body_from_camera), world_from_uav, seed)) {
  const double end_s = options.fault == "dead" ? std::min(options.fault_at_s, flight.duration_s())
                                               : flight.duration_s();
  // The navigation's clock is that of the first camera's images with their offset.
  const double ahead_s = landing.flight().errors().clock_offset_s - errors_.clock_offset_s;
  for (int i = 0; (i + kPhase) / options.rate_hz < end_s; ++i) {
    times_s_.push_back((i + kPhase) / options.rate_hz);
    times_.push_back(TimeOfFlight(times_s_.back() + ahead_s));
  }
}

// Returns when the light of an image fell on the sensor.
double SecondCamera::TimeInFlight(std::size_t index) const {
  const double time_s = times_s_[index];
  if (time_s < options_.fault_at_s || options_.fault != "late") return time_s;
  return std::max(time_s - kLate_s, 0.0);
}

cv::Mat SecondCamera::Image(std::size_t index) const {
  if (options_.fault == "frozen") {
    const auto frozen = std::lower_bound(times_s_.begin(), times_s_.end(), options_.fault_at_s);
    index = std::min(index, static_cast<std::size_t>(frozen - times_s_.begin()));
  }
  return camera_.Capture(TimeInFlight(index), 1,
                         Hash(SeedOf(seed_, SecondCameraPart::kNoise), index));
}

std::string SecondCamera::SceneText() const {
  return fmt::format(
      "cam1:\n"
      "  time_offset_s: {}\n"
      "  mount_error:\n    yaw_deg: {}\n    pitch_deg: {}\n    roll_deg: {}\n"
      "  true_T_BS:\n{}",
      errors_.clock_offset_s, errors_.mount_yaw_deg, errors_.mount_pitch_deg,
      errors_.mount_roll_deg,
      Indented(EurocTransformText(errors_.TrueMount(*nominal_.body_from_camera))));
}

std::vector<RecordingFile> SecondCamera::Files() const {
  std::string rows = LandingTruthHeader();
  std::string images = "#timestamp [ns],filename\n";
  for (std::size_t i = 0; i < times_.size(); ++i) {
    const auto seen = SeenPattern(times_[i], TimeInFlight(i), camera_, landing_.print(),
                                  landing_.world_from_pattern());
    if (seen) rows += LandingTruthRow(*seen);
    images += fmt::format("{0},{0}.png\n", ToNanoseconds(times_[i]));
  }
  return {{"cam1/sensor.yaml", EurocCameraText(nominal_, options_.rate_hz)},
          {"cam1/data.csv", images},
          {"landing_pattern0/cam1.csv", rows}};
}

}  // namespace kestrel
