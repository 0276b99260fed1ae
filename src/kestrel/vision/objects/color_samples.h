// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kestrel/vision/objects/color_model.h"

namespace kestrel {

// How many samples have which hue and saturation (paper, section 3.2). The hue is a circle: the
// first bin is the neighbour of the last.
class HueSaturationHistogram {
 public:
  static constexpr int kHues = 72;  // of 5 degrees each, the first from 0
  static constexpr int kSaturations = 25;

  void Add(const Hsv& color);
  std::uint32_t At(int hue, int saturation) const { return counts_[saturation * kHues + hue]; }
  // Row by row, from the lowest saturation.
  std::span<const std::uint32_t> counts() const { return counts_; }

  // Hue, degrees, at the edge of bins furthest from all samples: a strip of hues that begins there
  // does not cut what belongs together. 0 when there are no samples.
  double CutHue_deg() const;

 private:
  std::array<std::uint32_t, kHues * kSaturations> counts_{};
};

// What is wrong with samples that a colour is to be learnt from, a sentence each: few of them, hues
// that are mostly noise for want of saturation, values at the camera's limit.
std::vector<std::string> SampleWarnings(std::span<const Hsv> samples);

// The samples, or 'count' of them, evenly taken, when they are more.
std::vector<Hsv> EvenlyTaken(std::span<const Hsv> samples, std::size_t count);

// A mixture and why it has so many components.
struct MixtureChoice {
  ColorMixture mixture;
  // Bayesian information criterion of 1, 2, ... components, the lower the better.
  std::vector<double> criteria;
};

// FitColorMixture with the number of components, up to 'max_components', for which the Bayesian
// information criterion is the lowest. Neighbouring pixels say much the same, so that the criterion
// is of at most 2000 samples, evenly taken. Throws InputError for fewer than ten samples.
MixtureChoice ChooseColorMixture(const std::string& name, std::span<const Hsv> samples,
                                 int max_components);

}  // namespace kestrel
