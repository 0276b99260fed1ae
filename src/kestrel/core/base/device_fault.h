// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace kestrel {

// Returns why a device (/dev/video0, /dev/ttyAMA0) could not be opened, and what to do: one line
// that begins with its path. 'error': errno of the attempt.
std::string DeviceFault(const std::string& path, int error);

// Returns the programs that have the file open, as "gst-launch-1.0 (process 123)", other than this
// one; empty: none that this user may see.
std::string UsersOf(const std::string& path);

}  // namespace kestrel
