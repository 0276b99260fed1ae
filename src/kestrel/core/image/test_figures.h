// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "kestrel/core/image/binary_image.h"

namespace kestrel {

// A figure for tests: dark where 'is_dark' is true, and bright everywhere, so that every border can
// start.
inline BinaryImage DrawFigure(int width, int height, const std::function<bool(int, int)>& is_dark) {
  BinaryImage binary;
  binary.dark.Reset(width, height);
  binary.bright.Reset(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      binary.bright.Set(x, y);
      if (is_dark(x, y)) binary.dark.Set(x, y);
    }
  }
  return binary;
}

}  // namespace kestrel
