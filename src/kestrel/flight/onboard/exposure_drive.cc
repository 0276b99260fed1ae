// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/exposure_drive.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <utility>

namespace kestrel {
namespace {

bool SetControl(int device, std::uint32_t id, std::int32_t value) {
  v4l2_control control{};
  control.id = id;
  control.value = value;
  return ioctl(device, VIDIOC_S_CTRL, &control) == 0;
}

}  // namespace

ExposureDrive::ExposureDrive(const ExposureOptions& options, double exposure_s,
                             ExposureActuator* actuator)
    : controller_(options, exposure_s), actuator_(actuator) {}

void ExposureDrive::Update(const cv::Mat& image, const cv::Rect& area) {
  const double exposure_s = controller_.Update(image, area);
  if (exposure_s == set_s_) return;
  if (actuator_->SetExposure(exposure_s)) set_s_ = exposure_s;
}

V4l2ExposureActuator::V4l2ExposureActuator(std::string device) : device_(std::move(device)) {}

// Opens the device each time: it may go and come back, which makes an old descriptor useless.
bool V4l2ExposureActuator::SetExposure(double exposure_s) {
  constexpr double kUnit_s = 1e-4;
  const int device = open(device_.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
  if (device < 0) return false;
  SetControl(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL);  // not every driver has it
  const auto value = static_cast<std::int32_t>(std::lround(std::max(exposure_s / kUnit_s, 1.0)));
  const bool is_set = SetControl(device, V4L2_CID_EXPOSURE_ABSOLUTE, value);
  close(device);
  return is_set;
}

}  // namespace kestrel
