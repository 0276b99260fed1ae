// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace kestrel {

// The shares of colours, or of hues, in a region and around it. They give the probability that a
// pixel of a colour is of the region: Possegger et al., "In defense of color-based model-free
// tracking" (CVPR 2015), section 3.1. A colour is an index.
class ColorShares {
 public:
  explicit ColorShares(int colors);

  // Counts a pixel of the image to learn from.
  void Count(int color, bool is_inside) { ++(is_inside ? new_inside_ : new_around_)[color]; }
  // Forgets all shares, and learns those of what was counted.
  void Restart();
  // Learns the shares around the region, with a weight of 'rate', 0 to 1. Like Restart it begins a
  // new count, and learns nothing where no pixel was counted inside, or none around.
  void LearnAround(float rate) { Learn(0, rate); }

  int size() const { return static_cast<int>(inside_.size()); }
  bool IsKnown(int color) const { return inside_[color] + around_[color] > kUnknown; }
  // Returns the share of a colour in the region.
  float Inside(int color) const { return inside_[color]; }
  // Returns 0 to 1: 0.5, about, where a colour is unknown.
  float ProbabilityOf(int color) const { return probability_[color]; }

 private:
  static constexpr float kUnknown = 1e-4f;  // share of a colour that is known of neither

  void Learn(float rate_inside, float rate_around);

  std::vector<float> inside_, around_;          // shares of the colours
  std::vector<float> new_inside_, new_around_;  // pixels
  std::vector<float> probability_;
};

}  // namespace kestrel
