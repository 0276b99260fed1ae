// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/video_device.h"

#include <cerrno>
#include <cstddef>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <string_view>
#include <sys/ioctl.h>
#include <unistd.h>

#include "kestrel/core/base/device_fault.h"

namespace kestrel {
namespace {

// Empty: the camera names none.
std::string DeviceOf(const std::string& camera) {
  constexpr std::string_view kProperty = "device=";
  if (camera.starts_with("/dev/")) return camera;
  const std::size_t place = camera.find(kProperty);
  if (place == std::string::npos || camera.find("v4l2") == std::string::npos) return "";
  const std::size_t begin = camera.find_first_not_of('"', place + kProperty.size());
  return begin == std::string::npos
             ? ""
             : camera.substr(begin, camera.find_first_of("\" !", begin) - begin);
}

}  // namespace

std::string CameraFault(const std::string& camera) {
  const std::string path = DeviceOf(camera);
  if (path.empty()) return "";
  const int device = open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (device < 0) return DeviceFault(path, errno);
  v4l2_capability capability{};
  const bool is_video = ioctl(device, VIDIOC_QUERYCAP, &capability) == 0;
  close(device);
  if (!is_video) return path + ": is no video device";
  const bool has_own = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
  const auto can = has_own ? capability.device_caps : capability.capabilities;
  if ((can & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE)) == 0) {
    return path + ": gives no images (the second device of a camera, for its metadata, or a " +
           "converter): take another number, v4l2-ctl --list-devices shows them";
  }
  // Any number of programs can open a camera; only one gets its images.
  return UsersOf(path).empty() ? "" : DeviceFault(path, EBUSY);
}

}  // namespace kestrel
