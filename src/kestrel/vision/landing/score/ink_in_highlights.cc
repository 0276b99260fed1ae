// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/score/ink_in_highlights.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

constexpr float kEdgePx = 2.2f;  // from a sharp edge to ink that it does not brighten

// True if a highlight may make a place as bright as 'highlight', by the darkest ink within the
// reach of an edge ('near') and by the ink one row farther. The logarithm of its light rises less
// and less towards its middle.
bool MayHide(float highlight, float near, float far, const StrokeInk& ink) {
  constexpr float kNoise = 3;
  if (near < ink.veiled) return false;
  const float veil = near - ink.ink, farther = std::max(kNoise, far - kNoise - ink.ink);
  const float rise = std::max(1.0f, veil / farther);
  return !std::isfinite(veil * farther) ||
         veil * std::pow(rise, static_cast<float>(ink.edge_rows)) > highlight - ink.ink;
}

}  // namespace

int StrokeEdgeRows(float row_px, int rows) {
  constexpr int kLeast = 2;
  if (!(row_px * static_cast<float>(rows) > kEdgePx)) return rows;  // also of an unknown pitch
  return std::max(kLeast, static_cast<int>(std::ceil(kEdgePx / row_px)));
}

std::bitset<kMostStrokeRows> InkInHighlights(std::span<const float> stroke,
                                             std::span<const float> highlight,
                                             const StrokeInk& ink) {
  const int rows = static_cast<int>(highlight.size()), reach = ink.edge_rows;
  const auto gray = [&](int row) {
    return row < -1 || row > rows ? kUnknownGray : stroke[static_cast<std::size_t>(row + 1)];
  };
  const auto level = [&](int row) { return highlight[static_cast<std::size_t>(row)]; };
  const auto is_bright = [&](int row) {
    return row < rows && std::isfinite(gray(row)) && gray(row) >= level(row);
  };
  // Beside the row of a bright run that is nearest to the ink; 'step': away from the run.
  const auto may_hide = [&](int row, int step) {
    float darkest = kUnknownGray;
    for (int i = 1; i <= reach; ++i) darkest = std::min(darkest, gray(row + i * step));
    return MayHide(level(row), darkest, gray(row + (reach + 1) * step), ink);
  };
  std::bitset<kMostStrokeRows> hidden;
  for (int first = 0; first < rows; ++first) {
    if (!is_bright(first)) continue;
    int last = first;
    while (is_bright(last + 1)) ++last;
    if (may_hide(first, -1) && may_hide(last, 1)) {
      for (int row = first; row <= last; ++row) hidden.set(static_cast<std::size_t>(row));
    }
    first = last;
  }
  return hidden;
}

}  // namespace kestrel
