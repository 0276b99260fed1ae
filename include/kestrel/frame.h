// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// An image of a source, with its name and the time of its exposure.
//
// Example:
//   const Frame frame{.name = "cam0/0001.png", .time = Now(), .image = image};
//   std::cout << frame.name << ": " << frame.image.cols << " x " << frame.image.rows << "\n";

#include "kestrel/io/recording/frame.h"  // IWYU pragma: export
