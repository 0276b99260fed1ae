// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

namespace kestrel {

// One look at the image: at a resolution, and with what taken for dark, that suit rings of some
// sizes.
struct SearchPass {
  int image_level;          // the image at 1 / 2^level
  int tile_level;           // tiles of the threshold's box
  double min_ring_px;       // minor axis, full resolution
  double max_ring_px;       // major axis, full resolution
  bool black = false;       // dark is what is black: not what lies in a shadow
  bool top_hat = false;     // dark is what is narrow: not what lies in a shadow beside light
  bool closing = false;     // close gaps of the dark areas first
  bool not_bright = false;  // dark is all that is not bright
  bool narrow = false;      // borders beside narrow strokes of white as well
};

// What is looked for among the borders of a pass.
enum class SearchMethod {
  kAreas,     // closed dark areas, and the white board around them
  kCutAreas,  // dark areas that the image border cuts off
  kArcs,      // arcs of borders that lie on one circle
  kCross,     // the lines of a cross that has no ring in view
};

struct SearchStep {
  std::size_t pass;
  SearchMethod method;
};

inline constexpr std::size_t kSearchPasses = 10;
extern const std::array<SearchPass, kSearchPasses> kPasses;

// All that is done to an image in which the pattern is not found, in this order: near patterns
// first, for they are found at a sixteenth of the cost and matter most; closed areas, the cheaper
// way to a ring, before arcs, the surer one.
inline constexpr std::size_t kSearchSteps = 21;
extern const std::array<SearchStep, kSearchSteps> kSteps;

}  // namespace kestrel
