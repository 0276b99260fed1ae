// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/binary_image.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/core/image/binary_image.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Bit i of 'dark' = pixels[i] < dark_threshold[i], of 'bright' = pixels[i] > bright_threshold[i],
// for i < count, count a multiple of 64.
void CompareRow(const std::uint8_t* HWY_RESTRICT pixels,
                const std::uint8_t* HWY_RESTRICT dark_threshold,
                const std::uint8_t* HWY_RESTRICT bright_threshold, std::size_t count,
                std::uint64_t* HWY_RESTRICT dark, std::uint64_t* HWY_RESTRICT bright) {
#if HWY_TARGET == HWY_SCALAR
  std::fill(dark, dark + count / 64, 0);
  std::fill(bright, bright + count / 64, 0);
  for (std::size_t i = 0; i < count; ++i) {
    dark[i / 64] |= static_cast<std::uint64_t>(pixels[i] < dark_threshold[i]) << (i % 64);
    bright[i / 64] |= static_cast<std::uint64_t>(pixels[i] > bright_threshold[i]) << (i % 64);
  }
#else
  const hn::CappedTag<std::uint8_t, 64> d;
  auto* dark_bytes = reinterpret_cast<std::uint8_t*>(dark);
  auto* bright_bytes = reinterpret_cast<std::uint8_t*>(bright);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto pixel = hn::LoadU(d, pixels + i);
    hn::StoreMaskBits(d, hn::Lt(pixel, hn::LoadU(d, dark_threshold + i)), dark_bytes + i / 8);
    hn::StoreMaskBits(d, hn::Gt(pixel, hn::LoadU(d, bright_threshold + i)), bright_bytes + i / 8);
  }
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kestrel {
namespace {

HWY_EXPORT(CompareRow);

constexpr int kWordPx = 64;

}  // namespace

void Thresholds::Resize(std::size_t count) {
  dark.resize(count);
  bright.resize(count);
}

void Thresholds::ResetRow(int width) {
  const std::size_t padded = static_cast<std::size_t>(width / kWordPx + 1) * kWordPx;
  dark.assign(padded, 0);
  bright.assign(padded, 255);
}

void BinarizeRow(const std::uint8_t* pixels, int width, const Thresholds& thresholds, int y,
                 BinaryImage* binary) {
  const auto compare = [&](const std::uint8_t* from, int word, int words) {
    const std::size_t first = static_cast<std::size_t>(kWordPx) * word;
    HWY_DYNAMIC_DISPATCH(CompareRow)
    (from, &thresholds.dark[first], &thresholds.bright[first],
     static_cast<std::size_t>(kWordPx) * words, binary->dark.row(y) + word,
     binary->bright.row(y) + word);
  };
  const int words = width / kWordPx;
  const int rest = width - kWordPx * words;
  if (words > 0) compare(pixels, 0, words);
  if (rest == 0) return;
  // Copies the rest, so that nothing is read beyond the row.
  std::array<std::uint8_t, kWordPx> tail{};
  std::memcpy(tail.data(), pixels + width - rest, rest);
  compare(tail.data(), words, 1);
}

}  // namespace kestrel
#endif  // HWY_ONCE
