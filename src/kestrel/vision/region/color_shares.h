// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace kestrel {

// How often each colour, or hue, is in a region and around it, and how probably a pixel that has it
// is of the region: Possegger et al., "In defense of color-based model-free tracking" (CVPR 2015),
// section 3.1. A colour is an index.
class ColorShares {
 public:
  explicit ColorShares(int colors);

  // Counts a pixel of the next image to learn from.
  void Count(int color, bool is_inside) { ++(is_inside ? new_inside_ : new_around_)[color]; }
  // Forgets what was learnt, and learns what was counted. Both of these begin a new count, and
  // learn nothing where no pixel was counted inside, or none around.
  void Restart();
  // Learns what was counted around, with a weight of 'rate', 0 to 1.
  void LearnAround(float rate);

  int size() const { return static_cast<int>(inside_.size()); }
  bool IsKnown(int color) const { return inside_[color] + around_[color] > kUnknown; }
  // Returns the share of the region's pixels.
  float Inside(int color) const { return inside_[color]; }
  // Returns 0 to 1: 0.5, about, where a colour is unknown.
  float ProbabilityOf(int color) const { return probability_[color]; }

 private:
  static constexpr float kUnknown = 1e-4f;  // share of a colour that is known of neither

  bool FinishCount();
  void Rate();

  std::vector<float> inside_, around_;          // shares of the colours
  std::vector<float> new_inside_, new_around_;  // pixels
  std::vector<float> probability_;
};

}  // namespace kestrel
