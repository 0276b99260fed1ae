// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/flight_truth.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/io/recording/euroc/euroc_layout.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

constexpr Duration kMaxPoseGap = std::chrono::milliseconds(200);

std::string RootOf(const std::string& recording) {
  const std::optional<std::string> root = FindEurocRoot(recording);
  if (root) return *root;
  throw InputError(recording + ": no recording, expected a folder cam0 or mav0/cam0 in it");
}

std::vector<Time> ReadFrameTimes(const std::string& root) {
  const std::string file = (fs::path(root) / "cam0" / "data.csv").string();
  std::vector<Time> times;
  for (const ImageRow& row : ParseImageRows(ReadFile(file), file)) times.push_back(row.time);
  if (times.empty()) throw InputError(file + ": no rows, expected one for every image");
  return times;
}

SceneTruth ReadScene(const std::string& root) {
  const std::string file = (fs::path(root) / "scene.yaml").string();
  return fs::exists(file) ? ParseSceneTruth(ReadFile(file), file) : SceneTruth();
}

std::string CalibrationFile(const std::string& root) {
  return (fs::path(root) / "cam0" / "sensor.yaml").string();
}

CameraCalibration ReadMount(const std::string& root) {
  const std::string file = CalibrationFile(root);
  CameraCalibration calibration = ReadCalibration(file);
  if (calibration.body_from_camera) return calibration;
  throw InputError(file + ": no T_BS, expected the mount of the camera");
}

GimbalHistory ReadGimbal(const std::string& root, const CameraCalibration& calibration) {
  if (!calibration.gimbal) return GimbalHistory(0);
  const std::string file = (fs::path(root) / euroc::kTrueGimbal).string();
  const auto samples = ParseGimbalRows(ReadFile(file), file, YawFrame::kEarth);
  GimbalHistory gimbal(samples.size());
  for (const GimbalSample& sample : samples) gimbal.Add(sample);
  return gimbal;
}

PoseHistory ReadPoses(const std::string& root) {
  const std::string file = (fs::path(root) / "state_groundtruth_estimate0" / "data.csv").string();
  const std::vector<PoseSample> samples = ParsePoseRows(ReadFile(file), file, "RS");
  if (samples.empty()) throw InputError(file + ": no rows, expected the true poses of the UAV");
  PoseHistory poses(samples.size(), kMaxPoseGap);
  for (const PoseSample& sample : samples) poses.Add(sample);
  return poses;
}

}  // namespace

FlightTruth::FlightTruth(const std::string& recording)
    : root_(RootOf(recording)),
      frames_(ReadFrameTimes(root_)),
      scene_(ReadScene(root_)),
      camera_(ReadCalibration(CalibrationFile(root_)).intrinsics),
      calibration_(ReadMount(root_)),
      poses_(ReadPoses(root_)),
      gimbal_(ReadGimbal(root_, calibration_)) {}

void FlightTruth::RequireFrame(Time time, const std::string& row) const {
  if (std::binary_search(frames_.begin(), frames_.end(), time)) return;
  throw InputError(fmt::format(
      "{}: timestamp {} is not that of an image of {}, expected the results of this recording", row,
      ToNanoseconds(time), root_));
}

std::optional<RigidTransform> FlightTruth::WorldFromCamera(Time time) const {
  const std::optional<RigidTransform> world_from_body = WorldFromBody(time);
  if (!world_from_body) return std::nullopt;
  const auto true_mount = [this](const RigidTransform& nominal) {
    return RigidTransform{scene_.mount_error * nominal.rotation, nominal.translation};
  };
  const auto& gimbal = calibration_.gimbal;
  if (!gimbal) return *world_from_body * true_mount(*calibration_.body_from_camera);
  const auto attitude = gimbal_.At(time, Duration::zero());
  if (!attitude) return std::nullopt;
  return WorldFromPlatform(*world_from_body, gimbal->body_from_pivot, *attitude) *
         true_mount(gimbal->platform_from_camera);
}

}  // namespace kestrel
