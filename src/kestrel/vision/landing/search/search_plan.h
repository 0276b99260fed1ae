// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

namespace kestrel {

// A pass: one look at the image at one resolution, with one definition of dark, suited to a range
// of ring sizes.
struct SearchPass {
  // Outlines may be thinner than the rings of the pass, and wider: factors of the extents.
  static constexpr double kThinnest = 0.7;
  static constexpr double kWidest = 1.2;

  int image_level;          // the image at 1 / 2^level
  int tile_level;           // tiles of 2^tile_level pixels make the threshold's box
  double min_ring_px;       // minor axis, full resolution
  double max_ring_px;       // major axis, full resolution
  bool black = false;       // dark is only what is black, not what lies in a shadow
  bool top_hat = false;     // dark is only what is narrow, not what lies in a shadow beside light
  bool not_bright = false;  // dark is everything that is not bright
  bool narrow = false;      // also follows borders beside narrow strokes of white
};

// The kind of figure that is searched among the borders of a pass.
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

inline constexpr std::size_t kSearchPasses = 9;
extern const std::array<SearchPass, kSearchPasses> kPasses;

// All steps of a search, in order. Near patterns come first: finding them costs a sixteenth, and
// they matter most. Closed areas, the cheaper way to a ring, come before arcs, the more reliable
// one. bench/step_ablation measures what each step finds that no other one finds.
inline constexpr std::size_t kSearchSteps = 17;
extern const std::array<SearchStep, kSearchSteps> kSteps;

}  // namespace kestrel
