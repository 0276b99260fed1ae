// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bitset>
#include <cstddef>
#include <limits>
#include <span>

namespace kestrel {

inline constexpr float kUnknownGray = std::numeric_limits<float>::infinity();

// Gray values of the ink of a print.
struct StrokeInk {
  float ink;      // in the least light
  float veiled;   // from which on light lies on it
  int edge_rows;  // rows of a stroke that the blur of a sharp edge may brighten
};

// Returns that number of rows, at least two, of a stroke of 'rows' rows that are 'row_px' apart.
int StrokeEdgeRows(float row_px, int rows);

// Returns which rows of a stroke a highlight may hide. 'stroke': gray values along it, with one
// more place of ink at either end, kUnknownGray where out of view; 'highlight': the gray value from
// which on each row is bright. A highlight fades out, so that the ink next to it is veiled, and
// more so from row to row. Where that ink is as dark as elsewhere, or evenly veiled, the white is
// the board's: when overexposed it is as bright as a highlight.
inline constexpr std::size_t kMostStrokeRows = 16;
std::bitset<kMostStrokeRows> InkInHighlights(std::span<const float> stroke,
                                             std::span<const float> highlight,
                                             const StrokeInk& ink);

}  // namespace kestrel
