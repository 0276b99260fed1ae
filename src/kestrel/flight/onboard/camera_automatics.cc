// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/camera_automatics.h"

#include <cstdint>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace kestrel {
namespace {

std::optional<std::int32_t> ReadControl(int device, std::uint32_t id) {
  v4l2_control control{};
  control.id = id;
  if (ioctl(device, VIDIOC_G_CTRL, &control) != 0) return std::nullopt;
  return control.value;
}

}  // namespace

CameraAutomatics ReadCameraAutomatics(const std::string& device) {
  CameraAutomatics automatics;
  const int opened = open(device.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
  if (opened < 0) return automatics;
  if (const auto white_balance = ReadControl(opened, V4L2_CID_AUTO_WHITE_BALANCE)) {
    automatics.white_balance = *white_balance != 0;
  }
  if (const auto exposure = ReadControl(opened, V4L2_CID_EXPOSURE_AUTO)) {
    automatics.exposure = *exposure != V4L2_EXPOSURE_MANUAL;
  }
  constexpr double kExposureUnit_s = 1e-4;
  if (const auto exposure = ReadControl(opened, V4L2_CID_EXPOSURE_ABSOLUTE)) {
    automatics.exposure_s = kExposureUnit_s * *exposure;
  }
  close(opened);
  return automatics;
}

std::vector<std::string> ColorWarnings(const CameraAutomatics& automatics) {
  std::vector<std::string> warnings;
  if (automatics.white_balance.value_or(false)) {
    warnings.emplace_back(
        "the camera's white balance is automatic: hues change with what is in view; switch it off");
  }
  if (automatics.exposure.value_or(false)) {
    warnings.emplace_back(
        "the camera's exposure is automatic: keep frames of bright and of dark ground");
  }
  return warnings;
}

}  // namespace kestrel
