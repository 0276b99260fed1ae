// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kestrel/core/image/bit_image.h"

namespace kestrel {

// Dark and bright pixels of an image. All others are undecided.
struct BinaryImage {
  BitImage dark;
  BitImage bright;
};

// Gray values per tile or per pixel: pixels below 'dark' are dark, pixels above 'bright' are
// bright.
struct Thresholds {
  std::vector<std::uint8_t> dark;
  std::vector<std::uint8_t> bright;

  void Resize(std::size_t count);
  // Resizes for a row of 'width' pixels, in whole words, none of them dark or bright. Keeps its
  // memory when that is large enough.
  void ResetRow(int width);
};

// Decides the 'width' pixels of a row by their thresholds, made by ResetRow, and writes row 'y' of
// a binary image of that width. Reads no pixel beyond them.
void BinarizeRow(const std::uint8_t* pixels, int width, const Thresholds& thresholds, int y,
                 BinaryImage* binary);

}  // namespace kestrel
