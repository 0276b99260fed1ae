// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The dimensions of the landing pattern. The defaults are those of the MBZIRC 2017 board.
//
// Example:
//   const LandingPattern small{.outer_diameter_m = 0.6,
//                              .ring_width_m = 0.06,
//                              .arm_width_m = 0.06,
//                              .arm_half_length_m = 0.23,
//                              .board_size_m = 0.9};
//   for (const std::string& violation : ViolationsOf(small)) std::cerr << violation << "\n";

#include "kestrel/vision/landing/landing_pattern.h"  // IWYU pragma: export
