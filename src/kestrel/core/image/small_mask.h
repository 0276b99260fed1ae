// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace kestrel {

// Square binary image of at most 64 x 64 pixels, one word per row (bit x is pixel x), for the
// rectified inside of a candidate. A value type without heap memory.
class SmallMask {
 public:
  static constexpr int kMaxSize = 64;

  explicit SmallMask(int size = kMaxSize) : size_(size) {}

  int size() const { return size_; }
  // Clear outside of the mask.
  bool at(int x, int y) const {
    return x >= 0 && y >= 0 && x < size_ && y < size_ && ((rows_[y] >> x) & 1) != 0;
  }
  void Set(int x, int y) { rows_[y] |= std::uint64_t{1} << x; }
  void Clear(int x, int y) { rows_[y] &= ~(std::uint64_t{1} << x); }
  // Returns row 'y'; empty outside of the mask.
  std::uint64_t row(int y) const { return y < 0 || y >= size_ ? 0 : rows_[y]; }
  void SetRow(int y, std::uint64_t bits) { rows_[y] = bits & columns(); }
  // The bits of all columns.
  std::uint64_t columns() const { return ~std::uint64_t{0} >> (kMaxSize - size_); }

 private:
  int size_;
  std::array<std::uint64_t, kMaxSize> rows_{};
};

}  // namespace kestrel
