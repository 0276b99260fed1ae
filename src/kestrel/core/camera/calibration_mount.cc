// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/calibration_mount.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include "kestrel/core/base/load_yaml.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr double kMaxClockOffset_s = 4e9;    // fits into a Duration and spans two epochs
constexpr double kRotationTolerance = 1e-3;  // error of matrices typed with four digits
constexpr int kMaxDevice = 255;              // largest gimbal_device_id of MAVLink

RigidTransform RigidOf(const CalibrationEntry& entry, const Eigen::Matrix3d& rotation,
                       const Eigen::Vector3d& translation) {
  const double error =
      (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(error <= kRotationTolerance) || rotation.determinant() < 0) {
    entry.Fail("is not a rigid transform, expected a right-handed orthonormal rotation");
  }
  return {Eigen::Quaterniond(rotation).normalized(), translation};
}

template <int kRows>
Eigen::Matrix<double, kRows, kRows> SquareOf(const CalibrationEntry& entry) {
  const std::vector<double> m =
      entry.Numbers(kRows * kRows, fmt::format("a {0}x{0} matrix, row by row", kRows));
  return Eigen::Map<const Eigen::Matrix<double, kRows, kRows, Eigen::RowMajor>>(m.data());
}

RigidTransform TransformOf(const CalibrationEntry& entry) {
  const Eigen::Matrix4d matrix = SquareOf<4>(entry);
  const Eigen::Vector3d translation = matrix.topRightCorner<3, 1>();
  RigidTransform transform = RigidOf(entry, matrix.topLeftCorner<3, 3>(), translation);
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    entry.Fail("is not a rigid transform, expected 0, 0, 0, 1 in the last row");
  }
  return transform;
}

// Direction of the transform that a key has.
enum class MountKey { kNone, kBodyFromCamera, kCameraFromBody };

// The tools agree that T_AB, T_A_B or A_T_B maps coordinates in B to coordinates in A. They differ
// in their names of the body, which is the IMU for most, and of the first camera.
MountKey MountKeyOf(const std::string& key) {
  static constexpr std::array<std::string_view, 7> kBodies{"b", "body", "base", "baselink",
                                                           "i", "imu",  "s"};
  static constexpr std::array<std::string_view, 3> kCameras{"c", "cam", "camera"};
  std::string plain = PlainKey(key.substr(key.rfind('.') + 1));
  if (plain == "tbs") return MountKey::kBodyFromCamera;  // EuRoC: the sensor is the camera
  if (plain == "tsb") return MountKey::kCameraFromBody;
  std::erase(plain, '0');
  if (key.starts_with("IMU.")) std::erase(plain, '1');  // ORB-SLAM3 counts from 1
  const auto maps = [&](std::string_view to, std::string_view from) {
    return plain == fmt::format("t{}{}", to, from) || plain == fmt::format("{}t{}", to, from);
  };
  for (const std::string_view body : kBodies) {
    for (const std::string_view camera : kCameras) {
      if (maps(body, camera)) return MountKey::kBodyFromCamera;
      if (maps(camera, body)) return MountKey::kCameraFromBody;
    }
  }
  return MountKey::kNone;
}

struct Mount {
  CalibrationEntry entry;
  RigidTransform body_from_camera;
};

// The mount of VINS-Mono: rotation and translation from the camera to the IMU.
std::optional<Mount> SplitMount(const CalibrationEntry& camera) {
  const auto rotation = camera.Find({"extrinsicRotation"});
  if (!rotation) return std::nullopt;
  const std::vector<double> t =
      camera.Get({"extrinsicTranslation"}, "the place of the camera in the IMU's frame")
          .Numbers(3, "x, y, z");
  return Mount{*rotation, RigidOf(*rotation, SquareOf<3>(*rotation), {t[0], t[1], t[2]})};
}

std::vector<Mount> MountsOf(const CalibrationEntry& camera) {
  std::vector<Mount> mounts;
  for (const std::string& key : camera.Keys()) {
    const MountKey meaning = MountKeyOf(key);
    if (meaning == MountKey::kNone) continue;
    const CalibrationEntry entry = camera.Get({key.c_str()}, "the mount");
    const RigidTransform transform = TransformOf(entry);
    mounts.push_back(
        {entry, meaning == MountKey::kBodyFromCamera ? transform : transform.Inverse()});
  }
  if (const std::optional<Mount> split = SplitMount(camera)) mounts.push_back(*split);
  return mounts;
}

bool Agree(const RigidTransform& a, const RigidTransform& b) {
  return a.rotation.angularDistance(b.rotation) < 10 * kRotationTolerance &&
         (a.translation - b.translation).norm() < 10 * kRotationTolerance;
}

double ClockOffsetOf(const CalibrationEntry& entry) {
  const double offset_s = entry.Number();
  if (std::abs(offset_s) > kMaxClockOffset_s) {
    entry.Fail(
        fmt::format("is {} s, expected at most {} s either way", offset_s, kMaxClockOffset_s));
  }
  return offset_s;
}

// Returns the description of a gimbal or a zoom: the map itself, or sensor.yaml of the folder that
// it names, which stands beside the camera's folder. 'example': such a name.
CalibrationEntry DescriptionOf(const CalibrationEntry& entry, const char* example) {
  if (entry.node().IsMap()) return entry;
  const std::string name = entry.Text();
  if (name.empty() || name.find('/') != std::string::npos || name == "." || name == "..") {
    entry.Fail(
        fmt::format("is '{}', expected the name of a folder, as {}, or a map", name, example));
  }
  const std::filesystem::path camera_folder = std::filesystem::path(entry.file()).parent_path();
  const std::string file = (camera_folder / ".." / name / "sensor.yaml").lexically_normal();
  return {LoadYaml(ReadFile(file), file), file};
}

void SetClockAndDevice(const CalibrationEntry& description, Duration* clock_offset,
                       int* device_id) {
  if (const auto offset = description.Find({"time_offset_s"})) {
    *clock_offset = DurationFromSeconds(ClockOffsetOf(*offset));
  }
  if (const auto id = description.Find({"device_id"})) {
    *device_id = id->Integer();
    if (*device_id < 0 || *device_id > kMaxDevice) {
      id->Fail(fmt::format("is {}, expected 0 to {}", *device_id, kMaxDevice));
    }
  }
}

// A camera on a gimbal has T_GS, its place on the platform, in place of a mount on the body.
void SetGimbal(const CalibrationEntry& camera, CameraCalibration* calibration) {
  const auto gimbal = camera.Find({"gimbal"});
  const auto on_platform = camera.Find({"T_GS"});
  if (!gimbal && !on_platform) return;
  if (!gimbal) on_platform->Fail("is on a gimbal, expected a key 'gimbal' with its name, too");
  if (!on_platform) gimbal->Fail("has a camera without 'T_GS', expected camera to platform");
  if (calibration->body_from_camera) {
    on_platform->Fail("stands beside a mount on the body, expected one of them");
  }
  const CalibrationEntry description = DescriptionOf(*gimbal, "gimbal0");
  GimbalMount mount;
  mount.platform_from_camera = TransformOf(*on_platform);
  mount.body_from_pivot =
      TransformOf(description.Get({"T_BG"}, "the gimbal's platform, level and ahead, to body"));
  SetClockAndDevice(description, &mount.clock_offset, &mount.device_id);
  calibration->body_from_camera = mount.body_from_pivot * mount.platform_from_camera;
  calibration->gimbal = mount;
}

// One row of a zoom's table: the reported view, the focal lengths, the principal point, and the
// coefficients of the camera's distortion model.
ZoomLens::Setting SettingOf(const CalibrationEntry& table, const YAML::Node& row,
                            const CameraIntrinsics& lens) {
  const auto fail = [&] {
    table.Fail(fmt::format(
        "has a row that is no list of {} numbers, expected [hfov_deg, fu, fv, cu, cv{}]",
        5 + lens.distortion.size(), lens.distortion.empty() ? "" : ", the coefficients"));
  };
  std::vector<double> numbers;
  try {
    numbers = row.as<std::vector<double>>();
  } catch (const YAML::Exception&) {
    fail();
  }
  if (numbers.size() != 5 + lens.distortion.size()) fail();
  ZoomLens::Setting setting{Radians(numbers[0]), lens};
  setting.lens.fx_px = numbers[1];
  setting.lens.fy_px = numbers[2];
  setting.lens.cx_px = numbers[3];
  setting.lens.cy_px = numbers[4];
  setting.lens.distortion.assign(numbers.begin() + 5, numbers.end());
  const std::vector<std::string> violations = setting.lens.Validate();
  if (!violations.empty()) table.Fail(fmt::format("has a row whose {}", violations.front()));
  const double widest_deg = lens.distortion_model == DistortionModel::kEquidistant ? 360 : 180;
  if (!(numbers[0] > 0 && numbers[0] < widest_deg)) {
    table.Fail(
        fmt::format("has a row whose hfov_deg is {:g}, expected more than 0 and less than "
                    "{:g}",
                    numbers[0], widest_deg));
  }
  return setting;
}

// Without a table the file's own lens is the only setting, at the view that it has.
void SetZoom(const CalibrationEntry& camera, CameraCalibration* calibration) {
  const auto entry = camera.Find({"zoom"});
  if (!entry) return;
  const CalibrationEntry description = DescriptionOf(*entry, "zoom0");
  ZoomLens zoom;
  SetClockAndDevice(description, &zoom.clock_offset, &zoom.device_id);
  const CameraIntrinsics& lens = calibration->intrinsics;
  if (const auto table = description.Find({"settings"})) {
    if (!table->node().IsSequence()) table->Fail("is no list, expected a row for each setting");
    for (const YAML::Node& row : table->node()) {
      zoom.settings.push_back(SettingOf(*table, row, lens));
    }
    std::sort(zoom.settings.begin(), zoom.settings.end(),
              [](const auto& a, const auto& b) { return a.view_rad < b.view_rad; });
    const auto same = std::adjacent_find(
        zoom.settings.begin(), zoom.settings.end(),
        [](const auto& a, const auto& b) { return !(b.view_rad > 1.01 * a.view_rad); });
    if (same != zoom.settings.end()) table->Fail("has two rows of one hfov_deg, expected one");
  }
  if (zoom.settings.empty()) zoom.settings.push_back({ViewOf(lens), lens});
  calibration->zoom = zoom;
}

void SetMount(const CalibrationEntry& camera, CameraCalibration* calibration) {
  const std::vector<Mount> mounts = MountsOf(camera);
  if (mounts.empty()) return;
  const Mount& first = mounts.front();
  for (const Mount& other : mounts) {
    if (Agree(first.body_from_camera, other.body_from_camera)) continue;
    other.entry.Fail(
        fmt::format("is another mount than '{}', expected one of them", first.entry.key()));
  }
  calibration->body_from_camera = first.body_from_camera;
}

}  // namespace

void ReadMountAndClock(const CalibrationEntry& camera, CameraCalibration* calibration) {
  SetMount(camera, calibration);
  SetGimbal(camera, calibration);
  SetZoom(camera, calibration);
  // Kalibr, VINS (the same sign), and the cameras of a recording with several of them.
  const auto shift = camera.Find({"timeshift_cam_imu", "td", "time_offset_s"});
  if (shift) calibration->clock_offset = DurationFromSeconds(ClockOffsetOf(*shift));
}

}  // namespace kestrel
