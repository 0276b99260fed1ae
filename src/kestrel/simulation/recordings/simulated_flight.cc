// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/simulated_flight.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/hash.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/io/recording/euroc/euroc_layout.h"
#include "kestrel/io/recording/euroc/euroc_text.h"
#include "kestrel/simulation/recordings/truth_text.h"

namespace kestrel {
namespace {

// The poses begin before the first image and end after the last one, whatever the clock offset.
constexpr double kMargin_s = 0.5;

// Each part has its own random numbers.
enum class FlightPart { kErrors = 100, kPoses, kVibration, kGain, kNoise, kGimbal };
std::uint64_t SeedOf(std::uint64_t seed, FlightPart part) {
  return Hash(seed, static_cast<std::uint64_t>(part));
}
Random RandomOf(std::uint64_t seed, FlightPart part) { return Random(SeedOf(seed, part)); }

NavigationErrors ErrorsOf(const NavigationOptions& options, std::uint64_t seed) {
  Random random = RandomOf(seed, FlightPart::kErrors);
  return DrawNavigationErrors(options, &random);
}

// 'world_from_base': what the camera is fixed to, the body or a gimbal's platform.
Motion CameraMotion(const Motion& world_from_base, const RigidTransform& base_from_camera,
                    const NavigationOptions& options, std::uint64_t seed) {
  Random random = RandomOf(seed, FlightPart::kVibration);
  const auto vibration = Vibration(options, &random);
  return [=](double time_s) {
    return world_from_base(time_s) * base_from_camera *
           RigidTransform{vibration(time_s), Eigen::Vector3d::Zero()};
  };
}

// The camera of a calibration on a gimbal at its place, looking ahead when the gimbal is level.
CameraCalibration OnGimbal(CameraCalibration camera) {
  if (camera.gimbal) return camera;
  Eigen::Matrix3d axes;
  axes.col(0) = -Eigen::Vector3d::UnitY();
  axes.col(1) = -Eigen::Vector3d::UnitZ();
  axes.col(2) = Eigen::Vector3d::UnitX();
  GimbalMount mount;
  mount.body_from_pivot.translation = camera.body_from_camera->translation;
  mount.platform_from_camera.rotation = Eigen::Quaterniond(axes);
  camera.gimbal = mount;
  camera.body_from_camera = mount.body_from_pivot * mount.platform_from_camera;
  return camera;
}

CameraCalibration Nominal(const FlightRecordingOptions& options, CameraCalibration camera) {
  if (options.gimbal.is_there()) camera = OnGimbal(camera);
  const CameraIntrinsics& lens = camera.intrinsics;
  if (options.zoom.is_there()) camera.zoom = ZoomLens{{{ViewOf(lens), lens}}, {}};
  return camera;
}

std::function<double(double)> GainControl(const SensorOptions& options, std::uint64_t seed) {
  constexpr double kPeriod_s = 5;
  constexpr double kLeast = 0.1;
  Random random = RandomOf(seed, FlightPart::kGain);
  const auto wander = Wander(options.gain_variation, kPeriod_s, &random);
  return [=](double time_s) { return std::max(1 + wander(time_s), kLeast); };
}

}  // namespace

void RequireFixedLens(const ZoomOptions& zoom, std::vector<std::string>* violations) {
  if (!zoom.is_there()) return;
  violations->emplace_back("zoom.rate_hz is more than 0, expected 0: here the lens is fixed");
}

SimulatedFlight::SimulatedFlight(const FlightRecordingOptions& options,
                                 const CameraCalibration& camera, const Drawing& airframe,
                                 World world, Motion world_from_body, const Path& target,
                                 std::uint64_t seed)
    : options_(options),
      nominal_(Nominal(options, camera)),
      world_(std::move(world)),
      world_from_body_(std::move(world_from_body)),
      seed_(seed),
      errors_(ErrorsOf(options.navigation, seed)),
      gain_(GainControl(options.sensor, seed)) {
  for (int i = 0; i < options.frames; ++i) times_s_.push_back(i / options.rate_hz);
  LensOptions view;
  view.half_angle_deg = options.lens.half_angle_deg;
  view.vignette = options.lens.vignette;
  view.airframe = airframe;
  RigidTransform mount = *nominal_.body_from_camera;
  Motion world_from_base = world_from_body_;
  if (options.gimbal.is_there()) {
    gimbal_ = std::make_shared<SimulatedGimbal>(options.gimbal, world_from_body_,
                                                nominal_.gimbal->body_from_pivot, target, begin_s(),
                                                times_s_.back() + kMargin_s);
    mount = nominal_.gimbal->platform_from_camera;
    world_from_base = [gimbal = gimbal_](double time_s) {
      return gimbal->WorldFromPlatform(time_s);
    };
  }
  const Motion motion =
      CameraMotion(world_from_base, errors_.TrueMount(mount), options.navigation, seed);
  camera_ = std::make_unique<const ZoomingCamera>(
      options.zoom, camera.intrinsics, [this, view, motion](const CameraIntrinsics& lens) {
        return std::make_shared<const FlightCamera>(CameraModel(lens), view, options_.shutter,
                                                    options_.sensor, world_, motion);
      });
}

cv::Mat SimulatedFlight::Image(std::size_t index, double gain) const {
  const double time_s = times_s_[index];
  return CameraAt(time_s)->Capture(time_s, gain * gain_(time_s),
                                   Hash(SeedOf(seed_, FlightPart::kNoise), index));
}

void SimulatedFlight::EndBefore(std::size_t index) { times_s_.resize(index); }

NavigationSensor SimulatedFlight::navigation() const {
  return {options_.navigation, errors_, RandomOf(seed_, FlightPart::kPoses)};
}

double SimulatedFlight::begin_s() const { return -kMargin_s; }

std::string SimulatedFlight::SceneText(const std::string& kind) const {
  const Eigen::Vector3d& sun = world_.light.to_sun;
  const RigidTransform& mount =
      gimbal_ ? nominal_.gimbal->platform_from_camera : *nominal_.body_from_camera;
  const char* const frames = gimbal_ ? "GS" : "BS";
  return fmt::format(
      "kind: {}\n"
      "seed: {}\n"
      "image_timestamp: middle of the exposure (of the middle row)\n"
      "time_offset_s: {}  # t_nav = t_image + time_offset_s\n"
      "{}"
      "mount_error:  # R_{}_true = Rz(yaw) Ry(pitch) Rx(roll) R_{}_nominal, {} frame\n"
      "  yaw_deg: {}\n  pitch_deg: {}\n  roll_deg: {}\n"
      "true_T_{}:\n{}"
      "sun_direction: [{}, {}, {}]\n"
      "camera:\n{}",
      kind, seed_, errors_.clock_offset_s,
      gimbal_ ? fmt::format("gimbal_time_offset_s: {}  # t_nav = t_gimbal + gimbal_time_offset_s\n",
                            -options_.gimbal.stamp_delay_s)
              : "",
      frames, frames, gimbal_ ? "platform" : "body", errors_.mount_yaw_deg, errors_.mount_pitch_deg,
      errors_.mount_roll_deg, frames, EurocTransformText(errors_.TrueMount(mount)), sun.x(),
      sun.y(), sun.z(), Indented(EurocCameraText(nominal_, options_.rate_hz)));
}

std::vector<RecordingFile> SimulatedFlight::Files() const {
  const double end_s = times_s_.back() + kMargin_s;
  const auto poses = navigation().ReportAll(world_from_body_, begin_s(), end_s);
  std::vector<RecordingFile> files = {
      {euroc::kCamera, EurocCameraText(nominal_, options_.rate_hz)},
      {euroc::kPoseSensor, EurocPoseSensorText(options_.navigation.rate_hz)},
      {euroc::kPoses, EurocPoseText(poses)},
      {euroc::kTruePoses, TrueStateText(world_from_body_, begin_s(), end_s, times_s_)}};
  if (gimbal_) AddGimbal(&files);
  if (nominal_.zoom) AddZoom(&files);
  return files;
}

void SimulatedFlight::AddZoom(std::vector<RecordingFile>* files) const {
  files->push_back({euroc::kZoom, EurocZoomText(ZoomReportsOf(
                                      options_.zoom, nominal_.intrinsics, begin_s(),
                                      times_s_.back() + kMargin_s, errors_.clock_offset_s))});
  files->push_back(
      {euroc::kZoomSensor, EurocZoomSensorText(*nominal_.zoom, options_.zoom.rate_hz)});
}

void SimulatedFlight::AddGimbal(std::vector<RecordingFile>* files) const {
  const auto reports =
      gimbal_->Reports(errors_.clock_offset_s, Radians(options_.navigation.world_yaw_deg),
                       RandomOf(seed_, FlightPart::kGimbal));
  constexpr double kTruth_hz = 200;
  files->push_back({euroc::kGimbal, EurocGimbalText(reports)});
  files->push_back({euroc::kTrueGimbal, EurocGimbalText(gimbal_->Truth(kTruth_hz))});
  files->push_back(
      {euroc::kGimbalSensor, EurocGimbalSensorText(*nominal_.gimbal, reports.front().yaw_frame,
                                                   options_.gimbal.rate_hz)});
}

}  // namespace kestrel
