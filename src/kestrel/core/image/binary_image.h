// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kestrel/core/image/bit_image.h"

namespace kestrel {

// Dark and bright pixels of an image: what is neither is undecided.
struct BinaryImage {
  BitImage dark;
  BitImage bright;
};

// What is darker than 'dark' is dark, what is brighter than 'bright' is bright: gray values per
// tile or per pixel.
struct Thresholds {
  std::vector<std::uint8_t> dark;
  std::vector<std::uint8_t> bright;

  void Resize(std::size_t count);
  // Makes room for a row of 'width' pixels, in whole words, of which none is dark or bright; keeps
  // its memory when it is large enough.
  void ResetRow(int width);
};

// Decides the 'width' pixels of a row by the thresholds of each, made by ResetRow: row 'y' of a
// binary image of that width. Reads no pixel beyond them.
void BinarizeRow(const std::uint8_t* pixels, int width, const Thresholds& thresholds, int y,
                 BinaryImage* binary);

}  // namespace kestrel
