// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kestrel/vision/objects/hsv.h"

namespace kestrel {

// One Gaussian of a colour: of full covariance in hue (on the circle) and saturation, the value
// independent of both.
struct ColorComponent {
  double weight = 1;  // relative to the colour's other components, positive
  Hsv mean;
  Hsv sigma;               // standard deviations, positive
  double correlation = 0;  // of hue and saturation, between -1 and 1

  // Distance of 'color' from the mean in standard deviations.
  double Mahalanobis(const Hsv& color) const;
  // Logarithm of weight times density.
  double LogDensity(const Hsv& color) const;
};

// A named mixture of Gaussians in hue, saturation and value (paper, section 3.2).
struct ColorMixture {
  std::string name;
  std::vector<ColorComponent> components;

  double LogLikelihood(const Hsv& color) const;  // of the best component
  double Mahalanobis(const Hsv& color) const;    // from the nearest component
};

// The colours of the objects, and the ambiguous ones, that objects and other things have (the white
// digit on a coloured face).
struct ColorModel {
  std::vector<ColorMixture> colors;  // at most kMaxColors
  ColorMixture ambiguous{"ambiguous", {}};
  // A colour further than this from every component, in standard deviations, is background.
  double max_distance = 3;

  static constexpr std::size_t kMaxColors = 16;

  // Index of the most likely colour; nothing for background and for ambiguous colours.
  std::optional<std::size_t> Classify(const Hsv& color) const;

  // Every violation in words: no colour, no component, two colours of one name, values out of their
  // range, and contradictions: a component whose mean is more likely another colour.
  std::vector<std::string> Validate() const;
};

// The mixture of up to 'max_components' Gaussians that fits the samples (expectation maximisation
// from a start that is the same each time: no random numbers). A component keeps, in every
// direction, at least the deviations that the camera's noise gives (4 degrees, 0.04, 0.05). Throws
// InputError for fewer than ten samples.
ColorMixture FitColorMixture(const std::string& name, std::span<const Hsv> samples,
                             int max_components);

}  // namespace kestrel
