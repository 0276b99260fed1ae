// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Effects of lens and sensor on the image of a print: numbers that several stages share, and their
// origin.

namespace kestrel {

// Blur of optics and pixels: standard deviation of a Gaussian, px. Lenses in focus have 0.45 to
// 0.9 px (docs/location.md).
struct LensBlur {
  static constexpr double kGoodPx = 0.7;  // the middle of that range
  // Limits of a fit: a little beyond that range on either side.
  static constexpr double kLeastPx = 0.4;
  static constexpr double kMostPx = 1.2;
  // Standard deviation over lenses, of its logarithm and of its square: half of that range.
  static constexpr double kLogSpread = 0.35;
  static constexpr double kSquareSpreadPx2 = 0.3;
};

// Gray values of 8 bits, of which noise and rounding take one or two. White minus black.
struct GrayContrast {
  static constexpr float kLeast = 2;      // contrast of a print, and of an edge per pixel
  static constexpr float kLeastRing = 5;  // contrast of a ring that is worth a look at its inside
};

}  // namespace kestrel
