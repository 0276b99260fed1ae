// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace kestrel {

// What a camera changes by itself; nothing where its driver does not tell.
struct CameraAutomatics {
  std::optional<bool> white_balance;
  std::optional<bool> exposure;
};

// Of a V4L2 device, as "/dev/video0". Of what is none, or has no such controls, nothing is known.
// Does not throw.
CameraAutomatics ReadCameraAutomatics(const std::string& device);

// What of it spoils the teaching of colours, a sentence each.
std::vector<std::string> ColorWarnings(const CameraAutomatics& automatics);

}  // namespace kestrel
