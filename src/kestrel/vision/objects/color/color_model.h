// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kestrel/vision/objects/color/hsv.h"

namespace kestrel {

// One Gaussian of a colour, with full covariance in hue (on the circle) and saturation; the value
// is independent of both.
struct ColorComponent {
  double weight = 1;  // relative to the colour's other components, positive
  Hsv mean;
  Hsv sigma;               // standard deviations, positive
  double correlation = 0;  // correlation of hue and saturation, -1 to 1 exclusive

  // Mahalanobis distance of 'color' from the mean, in standard deviations.
  double Mahalanobis(const Hsv& color) const;
  // Logarithm of the weight times the density.
  double LogDensity(const Hsv& color) const;
};

// A named mixture of Gaussians in hue, saturation and value (paper, section 3.2).
struct ColorMixture {
  std::string name;
  std::vector<ColorComponent> components;

  double LogLikelihood(const Hsv& color) const;  // that of the best component
  double Mahalanobis(const Hsv& color) const;    // that of the nearest component
};

// The colours of the objects, and the ambiguous colours, which both objects and other things have
// (such as the white digit on a coloured face).
struct ColorModel {
  std::vector<ColorMixture> colors;  // at most kMaxColors
  ColorMixture ambiguous{"ambiguous", {}};
  // A colour farther than this from every component is background. Standard deviations.
  double max_distance = 3;

  static constexpr std::size_t kMaxColors = 16;

  // Returns the index of the most likely colour; nothing for background and for ambiguous colours.
  std::optional<std::size_t> Classify(const Hsv& color) const;

  // Returns every violation in words: no colours, no components, two colours with one name, values
  // out of range, and contradictions, where the mean of a component is more likely another colour.
  std::vector<std::string> Validate() const;
};

// Fits a mixture of up to 'max_components' Gaussians to the samples by expectation maximisation.
// Deterministic: the start uses no random numbers. A component has in every direction at least the
// standard deviations of the camera's noise (4 degrees, 0.04, 0.05). Throws InputError for fewer
// than ten samples.
ColorMixture FitColorMixture(const std::string& name, std::span<const Hsv> samples,
                             int max_components);

}  // namespace kestrel
