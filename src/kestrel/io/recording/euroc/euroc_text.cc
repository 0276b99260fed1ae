// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/euroc/euroc_text.h"

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

std::string PivotText(const GimbalMount& gimbal) {
  std::string text = "T_BG:\n" + EurocTransformText(gimbal.body_from_pivot);
  text += fmt::format("time_offset_s: {}\n", ToSeconds(gimbal.clock_offset));
  if (gimbal.device_id != 0) text += fmt::format("device_id: {}\n", gimbal.device_id);
  return text;
}

std::string Indented(const std::string& lines) {
  std::string text = "  " + lines;
  for (std::size_t at = text.find('\n'); at + 1 < text.size(); at = text.find('\n', at + 1)) {
    text.insert(at + 1, "  ");
  }
  return text;
}

std::string SettingsText(const ZoomLens& zoom) {
  std::string text = fmt::format("time_offset_s: {}\n", ToSeconds(zoom.clock_offset));
  if (zoom.device_id != 0) text += fmt::format("device_id: {}\n", zoom.device_id);
  text += "settings:  # hfov_deg as reported, fu, fv, cu, cv, coefficients\n";
  for (const auto& [view_rad, lens] : zoom.settings) {
    text += fmt::format("- [{}, {}, {}, {}, {}", Degrees(view_rad), lens.fx_px, lens.fy_px,
                        lens.cx_px, lens.cy_px);
    for (const double coefficient : lens.distortion) text += fmt::format(", {}", coefficient);
    text += "]\n";
  }
  return text;
}

std::string GimbalCameraText(const GimbalMount& gimbal, SensorPlace place) {
  const std::string text = "T_GS:\n" + EurocTransformText(gimbal.platform_from_camera);
  if (place == SensorPlace::kFolder) return text + "gimbal: gimbal0\n";
  return text + "gimbal:\n" + Indented(PivotText(gimbal));
}

}  // namespace

const char* DistortionName(DistortionModel model) {
  switch (model) {
    case DistortionModel::kEquidistant:
      return "equidistant";
    case DistortionModel::kRadialTangential:
      return "radial-tangential";
    default:
      return "none";
  }
}

std::string EurocTransformText(const RigidTransform& transform) {
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = transform.rotation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = transform.translation;
  const double* first = matrix.data();
  return fmt::format("  cols: 4\n  rows: 4\n  data: [{}]\n", fmt::join(first, first + 16, ", "));
}

std::string EurocCameraText(const CameraCalibration& calibration, double rate_hz,
                            SensorPlace place) {
  const CameraIntrinsics& camera = calibration.intrinsics;
  std::string text = fmt::format(
      "sensor_type: camera\n"
      "rate_hz: {}\n"
      "resolution: [{}, {}]\n"
      "camera_model: pinhole\n"
      "intrinsics: [{}, {}, {}, {}]\n"
      "distortion_model: {}\n"
      "distortion_coefficients: [{}]\n",
      rate_hz, camera.width_px, camera.height_px, camera.fx_px, camera.fy_px, camera.cx_px,
      camera.cy_px, DistortionName(camera.distortion_model), fmt::join(camera.distortion, ", "));
  if (calibration.gimbal) {
    text += GimbalCameraText(*calibration.gimbal, place);
  } else if (calibration.body_from_camera) {
    text += "T_BS:\n" + EurocTransformText(*calibration.body_from_camera);
  }
  if (!calibration.zoom) return text;
  if (place == SensorPlace::kFolder) return text + "zoom: zoom0\n";
  return text + "zoom:\n" + Indented(SettingsText(*calibration.zoom));
}

std::string EurocCalibrationText(const CameraCalibration& calibration, double rate_hz,
                                 SensorPlace place) {
  std::string text = EurocCameraText(calibration, rate_hz, place);
  if (calibration.clock_offset) {
    text += fmt::format("timeshift_cam_imu: {}\n", ToSeconds(*calibration.clock_offset));
  }
  return text;
}

std::string EurocPoseSensorText(double rate_hz) {
  return fmt::format("sensor_type: pose\nrate_hz: {}\n", rate_hz);
}

std::string EurocGimbalSensorText(const GimbalMount& gimbal, YawFrame yaw_frame, double rate_hz) {
  return fmt::format("sensor_type: gimbal\nrate_hz: {}\nyaw_frame: {}\n", rate_hz,
                     ToString(yaw_frame)) +
         PivotText(gimbal);
}

std::string EurocGimbalColumns() {
  return "#timestamp [ns],q_WG_w [],q_WG_x [],q_WG_y [],q_WG_z []";
}

std::string EurocGimbalCells(const GimbalSample& sample) {
  const Eigen::Quaterniond& q = sample.level_from_platform;
  return fmt::format("{},{:.9f},{:.9f},{:.9f},{:.9f}", ToNanoseconds(sample.time), q.w(), q.x(),
                     q.y(), q.z());
}

std::string EurocGimbalText(const std::vector<GimbalSample>& samples) {
  std::string text = EurocGimbalColumns() + "\n";
  for (const GimbalSample& sample : samples) text += EurocGimbalCells(sample) + "\n";
  return text;
}

std::string EurocZoomSensorText(const ZoomLens& zoom, double rate_hz) {
  return fmt::format("sensor_type: zoom\nrate_hz: {}\n", rate_hz) + SettingsText(zoom);
}

std::string EurocZoomColumns() { return "#timestamp [ns],hfov [rad]"; }

std::string EurocZoomCells(const ZoomSample& sample) {
  return fmt::format("{},{:.6f}", ToNanoseconds(sample.time), sample.view_rad);
}

std::string EurocZoomText(const std::vector<ZoomSample>& samples) {
  std::string text = EurocZoomColumns() + "\n";
  for (const ZoomSample& sample : samples) text += EurocZoomCells(sample) + "\n";
  return text;
}

std::string EurocPoseColumns(const std::string& frames) {
  return fmt::format(
      "#timestamp [ns],p_{0}_{1}_x [m],p_{0}_{1}_y [m],p_{0}_{1}_z [m],"
      "q_{0}_w [],q_{0}_x [],q_{0}_y [],q_{0}_z []",
      frames, frames.front());
}

std::string EurocPoseCells(Time time, const RigidTransform& pose) {
  const Eigen::Vector3d& p = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  return fmt::format("{},{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f}", ToNanoseconds(time),
                     p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
}

std::string EurocPoseText(const std::vector<PoseSample>& poses) {
  std::string text = EurocPoseColumns("WB") + "\n";
  for (const PoseSample& pose : poses) {
    text += EurocPoseCells(pose.time, pose.world_from_body) + "\n";
  }
  return text;
}

}  // namespace kestrel
