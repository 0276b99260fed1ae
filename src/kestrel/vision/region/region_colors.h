// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "kestrel/vision/region/window_sampler.h"

namespace kestrel {

// The colours of a region, beside those around it: where they differ they show how far the region
// reaches, which changes when it turns. The probability of a pixel is that of Possegger et al., "In
// defense of color-based model-free tracking" (CVPR 2015), section 3.1.
class RegionColors {
 public:
  explicit RegionColors(int side);  // of the windows, px

  // A box in a window, px.
  struct Box {
    Eigen::Vector2d middle, size;
  };

  // Learns the colours in the box and around it. Does not allocate.
  void Mark(const SampledWindow& window, const Box& box);
  // Learns the colours around the box. Those in it are learnt once: a box that is too large would
  // take the ground for the region. Does not allocate.
  void LearnAround(const SampledWindow& window, const Box& box);
  // Returns the box around the region's colours near 'box'; nothing where they end nowhere, or are
  // those around it as well. Does not allocate.
  std::optional<Box> Fit(const SampledWindow& window, const Box& box);

 private:
  struct Extent {
    double first, last;
  };
  struct Band {
    int first, last;
  };

  void Count(const SampledWindow& window, const Box& box);
  void Rate();
  void Project(const SampledWindow& window, int axis, Band across);
  std::optional<Extent> ExtentAlong(int axis, const SampledWindow& window, const Box& box);
  std::optional<double> EndOf(double middle, double half, float edge, int step) const;

  int side_;
  std::vector<float> inside_, around_;          // shares of the colours
  std::vector<float> new_inside_, new_around_;  // of one image
  std::vector<float> probability_;              // that a pixel of a colour is of the region
  std::vector<float> profile_;                  // its mean across an axis
};

}  // namespace kestrel
