// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kestrel {

// Binary image with one bit per pixel. At least one clear bit surrounds the image on all sides, so
// that the neighbours of every pixel can be read without a test.
class BitImage {
 public:
  // Resizes and clears the image. Keeps its memory when that is large enough.
  void Reset(int width, int height) {
    width_ = width;
    height_ = height;
    words_per_row_ = width / 64 + 1;
    words_.resize(static_cast<std::size_t>(words_per_row_) * (height + 2) + 2);
    std::fill(words_.begin(), words_.end(), 0);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  int words_per_row() const { return words_per_row_; }

  // Words of row 'y', -1 to height(). Bit x % 64 of word x / 64 is pixel x. All bits right of the
  // image are clear, and so is the word before the row.
  std::uint64_t* row(int y) {
    return words_.data() + 1 + static_cast<std::size_t>(y + 1) * words_per_row_;
  }
  const std::uint64_t* row(int y) const {
    return words_.data() + 1 + static_cast<std::size_t>(y + 1) * words_per_row_;
  }

  // 'x' from -1 to width(), 'y' from -1 to height(); clear outside of the image.
  bool at(int x, int y) const { return (row(y)[x >> 6] >> (x & 63)) & 1; }
  void Set(int x, int y) { row(y)[x >> 6] |= std::uint64_t{1} << (x & 63); }

 private:
  int width_ = 0;
  int height_ = 0;
  int words_per_row_ = 0;
  std::vector<std::uint64_t> words_;
};

// Writes the complement of 'image' to 'inverse'.
void InvertBits(const BitImage& image, BitImage* inverse);

}  // namespace kestrel
