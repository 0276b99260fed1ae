// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/recording/euroc_text.h"

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace kestrel {
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

std::string EurocCameraText(const CameraCalibration& calibration, double rate_hz) {
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
  if (calibration.body_from_camera) {
    text += "T_BS:\n" + EurocTransformText(*calibration.body_from_camera);
  }
  return text;
}

std::string EurocPoseSensorText(double rate_hz) {
  return fmt::format("sensor_type: pose\nrate_hz: {}\n", rate_hz);
}

std::string EurocPoseText(const std::vector<PoseSample>& poses) {
  std::string text =
      "#timestamp [ns],p_WB_W_x [m],p_WB_W_y [m],p_WB_W_z [m],"
      "q_WB_w [],q_WB_x [],q_WB_y [],q_WB_z []\n";
  for (const PoseSample& pose : poses) {
    const Eigen::Vector3d& p = pose.world_from_body.translation;
    const Eigen::Quaterniond& q = pose.world_from_body.rotation;
    text += fmt::format("{},{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f}\n",
                        ToNanoseconds(pose.time), p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
  }
  return text;
}

}  // namespace kestrel
