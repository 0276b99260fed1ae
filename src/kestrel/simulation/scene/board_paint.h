// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/drawing.h"
#include "kestrel/simulation/scene/texture.h"
#include "kestrel/vision/target/target_print.h"

namespace kestrel {

// Returns all of a print that differs from its board, turned by 'yaw' (rad).
Drawing InkOf(const TargetPrint& print, double yaw = 0);

// Wear of a board, and the frame around it.
struct BoardWear {
  double border_m = 0;  // width of the dark frame
  double dirt = 0;      // relative variation of the reflectance
  int scratches = 0;    // places without ink
};

// Returns the paint of the board with its print and its frame.
std::shared_ptr<const Texture> BoardPaint(const TargetPrint& print, const BoardWear& wear,
                                          int channels, Random* random);

}  // namespace kestrel
