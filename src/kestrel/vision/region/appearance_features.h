// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/vision/region/grid_spectrum.h"
#include "kestrel/vision/region/window_sampler.h"

namespace kestrel {

// What a cell of a window looks like: gradients by direction, brightness and colour.
//
// The gradients are those of Felzenszwalb et al., "Object detection with discriminatively trained
// part-based models" (PAMI 2010), section 6: histograms of 18 directions and of 9 orientations,
// each normalised by four neighbourhoods.
class AppearanceFeatures {
 public:
  static constexpr int kDirections = 18;
  static constexpr int kGradientChannels = kDirections + kDirections / 2;
  static constexpr int kChannels = 32;  // and gray, and four of colour or, in gray images, texture

  // 'cells' by 'cells' cells of 'cell_px' by 'cell_px' pixels.
  AppearanceFeatures(int cells, int cell_px);

  // 'window': as many pixels as the cells have. Does not allocate.
  void Compute(const SampledWindow& window, FeatureGrid* features);

 private:
  void ComputeHistograms(const std::vector<float>& gray);
  void Normalize(FeatureGrid* features);
  void AddMeans(const SampledWindow& window, FeatureGrid* features) const;

  int cells_, cell_px_, side_;
  std::vector<int> left_cell_;     // by column: where in 'row_' the first of its two cells begins
  std::vector<float> right_;       // by column: the share of the second
  std::vector<float> gray_;        // gray values where the window is in colour
  std::vector<float> histograms_;  // by cell, 18 directions
  std::vector<float> row_;         // histograms of a row of pixels
  std::vector<float> energy_, magnitude_, bin_;
  std::vector<float> inverse_norm_;  // at the corners between cells
};

}  // namespace kestrel
