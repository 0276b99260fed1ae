// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel convert SOURCE DESTINATION`: between EuRoC folders and the bags of ROS 1 and ROS 2.
void AddConvertCommand(CLI::App* app);

}  // namespace kestrel
