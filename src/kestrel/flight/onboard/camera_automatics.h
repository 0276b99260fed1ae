// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace kestrel {

// Adjustments of a camera; nothing where its driver does not report them.
struct CameraAutomatics {
  std::optional<bool> white_balance;      // is automatic
  std::optional<bool> exposure;           // is automatic
  std::optional<double> exposure_s = {};  // length of the exposure
};

// Reads them from a V4L2 device, as "/dev/video0". Nothing is known of another kind of device, or
// of one without such controls. Does not throw.
CameraAutomatics ReadCameraAutomatics(const std::string& device);

// Returns one sentence for each adjustment that spoils the training of colours.
std::vector<std::string> ColorWarnings(const CameraAutomatics& automatics);

}  // namespace kestrel
