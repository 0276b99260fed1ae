// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kestrel/vision/objects/color/color_model.h"

namespace kestrel {

// Histogram of the samples' hues and saturations (paper, section 3.2). The hue is a circle: the
// first bin is the neighbour of the last.
class HueSaturationHistogram {
 public:
  static constexpr int kHues = 72;  // bins of 5 degrees each, the first from 0
  static constexpr int kSaturations = 25;

  void Add(const Hsv& color);
  std::uint32_t At(int hue, int saturation) const { return counts_[saturation * kHues + hue]; }
  // Counts row by row, from the lowest saturation.
  std::span<const std::uint32_t> counts() const { return counts_; }

  // Returns the hue, degrees, at the edge of bins farthest from all samples. A strip of hues that
  // begins there does not separate neighbouring samples. 0 when there are no samples.
  double CutHue_deg() const;

 private:
  std::array<std::uint32_t, kHues * kSaturations> counts_{};
};

// Returns the problems of samples from which a colour is to be learnt, one sentence each: few
// samples, hues that are mostly noise because the saturation is low, values at the camera's limits.
std::vector<std::string> SampleWarnings(std::span<const Hsv> samples);

// Returns the samples, or an evenly spaced subset of 'count' of them when there are more.
std::vector<Hsv> EvenlyTaken(std::span<const Hsv> samples, std::size_t count);

// A mixture and the criteria for its number of components.
struct MixtureChoice {
  ColorMixture mixture;
  // Bayesian information criterion for 1, 2, ... components; lower is better.
  std::vector<double> criteria;
};

// Runs FitColorMixture with the number of components, up to 'max_components', that has the lowest
// Bayesian information criterion. Neighbouring pixels are much alike, so the criterion uses at most
// 2000 evenly spaced samples. Throws InputError for fewer than ten samples.
MixtureChoice ChooseColorMixture(const std::string& name, std::span<const Hsv> samples,
                                 int max_components);

}  // namespace kestrel
