// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/region/grid_spectrum.h"

#include <complex>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

FeatureGrid RandomGrid(int side, int channels) {
  Random random(7);
  FeatureGrid grid(side, channels);
  for (float& value : grid.values) value = static_cast<float>(random.Normal());
  return grid;
}

TEST(GridTransform, ForwardIsTheFourierTransformOfEachChannel) {
  constexpr int kSide = 8, kChannels = 6;
  const FeatureGrid grid = RandomGrid(kSide, kChannels);
  const GridTransform transform(kSide, kChannels);
  FeatureGrid copy = grid;
  GridSpectrum spectrum(kSide, kChannels);
  transform.Forward(&copy, &spectrum);
  for (int c = 0; c < kChannels; ++c) {
    for (int ky = 0, bin = 0; ky < kSide; ++ky) {
      for (int kx = 0; kx <= kSide / 2; ++kx, ++bin) {
        std::complex<double> sum = 0;
        for (int y = 0; y < kSide; ++y) {
          for (int x = 0; x < kSide; ++x) {
            sum +=
                double{grid.Cell(x, y)[c]} * std::polar(1.0, -2 * kPi * (kx * x + ky * y) / kSide);
          }
        }
        EXPECT_NEAR(spectrum.Bin(bin)[c], sum.real(), 1e-4);
        EXPECT_NEAR(spectrum.Bin(bin)[kChannels + c], sum.imag(), 1e-4);
      }
    }
  }
}

TEST(GridTransform, InverseGivesTheGridBack) {
  constexpr int kSide = 32, kChannels = 10;
  const FeatureGrid grid = RandomGrid(kSide, kChannels);
  const GridTransform transform(kSide, kChannels);
  FeatureGrid copy = grid, back(kSide, kChannels);
  GridSpectrum spectrum(kSide, kChannels);
  transform.Forward(&copy, &spectrum);
  transform.Inverse(spectrum, &back);
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    ASSERT_NEAR(back.values[i], grid.values[i], 1e-5);
  }
}

}  // namespace
}  // namespace kestrel
