// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel convert SOURCE DESTINATION`: converts between EuRoC folders and bags of ROS 1 and ROS 2.
void AddConvertCommand(CLI::App* app);

}  // namespace kestrel
