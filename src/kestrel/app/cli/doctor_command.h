// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel doctor`: says what is wrong with camera, calibration, mount, autopilot and computer, and
// what to do about it.
void AddDoctorCommand(CLI::App* app);

}  // namespace kestrel
