// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/camera_info.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/calibration_reader.h"

namespace kestrel {
namespace {

// Makes a name from a bag safe for YAML and messages.
std::string PlainName(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c) && c != '-'; }, '_');
  return name.substr(0, 60);
}

}  // namespace

CameraCalibration CalibrationOf(const CameraInfoMessage& message, bool is_rectified,
                                const std::string& name) {
  const auto& p = message.p;
  const std::array<double, 9> k =
      is_rectified ? std::array<double, 9>{p[0], p[1], p[2], p[4], p[5], p[6], p[8], p[9], p[10]}
                   : message.k;
  const bool is_distorted = !is_rectified && !message.d.empty();
  const std::string text = fmt::format(
      "width: {}\nheight: {}\nK: [{}]\ndistortion_model: {}\nD: [{}]\n"
      "binning_x: {}\nbinning_y: {}\n"
      "roi: {{x_offset: {}, y_offset: {}, width: {}, height: {}}}\n",
      message.width, message.height, fmt::join(k, ", "),
      is_distorted ? PlainName(message.distortion_model) : "none",
      fmt::join(is_distorted ? message.d : std::vector<double>(), ", "), message.binning_x,
      message.binning_y, message.roi.x_offset, message.roi.y_offset, message.roi.width,
      message.roi.height);
  return ParseCalibration(text, name);
}

CameraInfoMessage CameraInfoOf(const CameraIntrinsics& camera) {
  CameraInfoMessage message;
  message.width = static_cast<std::uint32_t>(camera.width_px);
  message.height = static_cast<std::uint32_t>(camera.height_px);
  message.d = camera.distortion;
  switch (camera.distortion_model) {
    case DistortionModel::kNone:
      message.distortion_model = "plumb_bob";
      break;
    case DistortionModel::kRadialTangential:
      message.distortion_model = camera.distortion.size() > 5 ? "rational_polynomial" : "plumb_bob";
      break;
    case DistortionModel::kEquidistant:
      message.distortion_model = "equidistant";
      break;
  }
  message.k = {camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1};
  message.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  message.p = {camera.fx_px, 0, camera.cx_px, 0, 0, camera.fy_px, camera.cy_px, 0, 0, 0, 1, 0};
  return message;
}

}  // namespace kestrel
