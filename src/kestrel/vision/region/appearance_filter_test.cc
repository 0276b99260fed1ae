// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/region/appearance_filter.h"

#include <complex>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr int kFilterCells = 32, kFilterFeatures = 8;

// Returns the spectrum of the same features, moved by a part of a cell.
GridSpectrum MoveFeatures(GridSpectrum spectrum, const Eigen::Vector2d& cells) {
  for (int row = 0; row < kFilterCells; ++row) {
    const int ky = row < kFilterCells / 2 ? row : row - kFilterCells;
    for (int kx = 0; kx <= kFilterCells / 2; ++kx) {
      const auto phase =
          std::polar(1.0, -2 * kPi / kFilterCells * (kx * cells.x() + ky * cells.y()));
      float* bin = spectrum.Bin(row * (kFilterCells / 2 + 1) + kx);
      for (int c = 0; c < kFilterFeatures; ++c) {
        const std::complex<double> value =
            phase * std::complex<double>(bin[c], bin[kFilterFeatures + c]);
        bin[c] = static_cast<float>(value.real());
        bin[kFilterFeatures + c] = static_cast<float>(value.imag());
      }
    }
  }
  return spectrum;
}

// Between cells a sharp response is flat over four of them.
TEST(AppearanceFilterTest, FindReturnsPlaceAndValueOfMaximumBetweenCells) {
  FilterWorkspace workspace(kFilterCells, kFilterFeatures);
  AppearanceFilter filter(kFilterCells, kFilterFeatures);
  Random random(1);
  for (int round = 0; round < 20; ++round) {
    FeatureGrid grid(kFilterCells, kFilterFeatures);
    for (float& value : grid.values) value = static_cast<float>(random.Normal());
    GridSpectrum sample(kFilterCells, kFilterFeatures);
    workspace.transform.Forward(&grid, &sample);
    filter.Reset({6, 7}, &workspace);
    filter.Learn(sample, 0, &workspace);
    const double usual = filter.Find(sample, &workspace).value;
    for (const double x : {-0.5, -0.2, 0.4, 0.5}) {
      for (const double y : {-0.5, 0.1, 0.5}) {
        const FilterPeak peak = filter.Find(MoveFeatures(sample, {x, y}), &workspace);
        EXPECT_LT((peak.displacement - Eigen::Vector2d(x, y)).norm(), 0.1) << x << " " << y;
        EXPECT_NEAR(peak.value, usual, 0.1 * usual) << x << " " << y;
      }
    }
  }
}

}  // namespace
}  // namespace kestrel
