// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace kestrel {

// Returns why the V4L2 device (/dev/video0) delivers no images, and what to do: missing, no
// permission, in use by whom, no camera. Empty: nothing is wrong with it that can be seen from
// here.
std::string VideoDeviceFault(const std::string& path);

}  // namespace kestrel
