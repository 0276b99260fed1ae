// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace kestrel {

// Returns why a camera delivers no images, and what to do: its V4L2 device (/dev/video0, or that of
// a pipeline with v4l2src device=/dev/video0) is missing, without permission, in use by whom, no
// camera. Empty: nothing is wrong with it that can be seen from here, or it names no such device.
std::string CameraFault(const std::string& camera);

}  // namespace kestrel
