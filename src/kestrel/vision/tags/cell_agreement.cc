// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/cell_agreement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kestrel/core/base/robust_statistics.h"

namespace kestrel {
namespace {

constexpr std::size_t kMostCells = 1296;   // a fractal marker has 32 bits a side
constexpr int kNeighbors = 2;              // cells around a cell that it is held against
constexpr double kLeastCellContrast = 5;   // gray values, between white and black cells
constexpr double kLeastDimContrast = 0.4;  // as logarithms: a shaded white cell to black ones
constexpr double kClear = 0.5;             // agreement that is beyond doubt
constexpr double kSameShade = 0.2;         // as logarithms: between two white cells in a shadow

// Sums over the cells of one colour.
struct ColorSum {
  double gray = 0, log = 0;
  int count = 0;
};

// Returns the place of a gray value between those of the cells of the other colour (-1) and of its
// own colour (1).
double PlaceBetween(double value, double black, double white, bool is_white) {
  const double place = (value - 0.5 * (white + black)) / (0.5 * (white - black));
  return std::clamp(is_white ? place : -place, -1.0, 1.0);
}

// Returns the logarithm of the white square's gray value in a shadow over a tag; NaN where none
// falls on it.
double ShadedWhite(const TagGrid& grid, const std::vector<bool>& is_data,
                   std::span<const float> gray, std::span<const float> log) {
  constexpr double kShade = 0.7;           // as logarithms: half of the light
  constexpr std::size_t kLeastShaded = 2;  // one may be dirty
  std::array<float, kMostCells> white;
  std::size_t count = 0;
  for (std::size_t i = 0; i < gray.size(); ++i) {
    if (is_data[i] || grid.cells[i] != TagCell::kWhite || gray[i] < 0) continue;
    white[count++] = log[i];
  }
  if (count == 0) return NAN;
  const std::span<float> seen(white.data(), count);
  const double most_shaded = MedianInPlace(seen) - kShade;
  const auto sunny =
      std::partition(seen.begin(), seen.end(), [&](float value) { return value < most_shaded; });
  const auto shaded = seen.first(static_cast<std::size_t>(sunny - seen.begin()));
  return shaded.size() < kLeastShaded ? NAN : MedianInPlace(shaded);
}

// Returns the place of a cell's gray value between those of the cells around it of the other colour
// (-1) and of its own colour (1); 0 where there are none, or where a shadow hides its colour. Lens
// and pixels mix gray values, a shadow multiplies them: of the places by gray values and by their
// logarithms the better one counts. 'shaded_white': as ShadedWhite.
double CellAgreement(const TagGrid& grid, std::span<const float> gray, std::span<const float> log,
                     double shaded_white, int column, int row, DimSample dim) {
  ColorSum sums[2];  // black and white cells
  for (int y = std::max(0, row - kNeighbors); y <= std::min(grid.width - 1, row + kNeighbors);
       ++y) {
    for (int x = std::max(0, column - kNeighbors);
         x <= std::min(grid.width - 1, column + kNeighbors); ++x) {
      const int i = y * grid.width + x;
      if (grid.cells[i] == TagCell::kNone || gray[i] < 0 || (x == column && y == row)) continue;
      ColorSum& sum = sums[grid.cells[i] == TagCell::kWhite];
      sum.gray += gray[i];
      sum.log += log[i];
      ++sum.count;
    }
  }
  const auto& [black, white] = sums;
  if (black.count == 0 || white.count == 0) return 0;
  if (white.gray / white.count - black.gray / black.count < kLeastCellContrast) return -1;
  const int i = row * grid.width + column;
  const bool is_white = grid.cells[i] == TagCell::kWhite;
  const double by_gray =
      PlaceBetween(gray[i], black.gray / black.count, white.gray / white.count, is_white);
  const double log_contrast = white.log / white.count - black.log / black.count;
  if (!(log_contrast > 0)) return by_gray;
  const double place = std::max(
      by_gray, PlaceBetween(log[i], black.log / black.count, white.log / white.count, is_white));
  const bool is_dim = is_white && log[i] - black.log / black.count > kLeastDimContrast;
  if (is_dim && std::abs(log[i] - shaded_white) < kSameShade) return std::max(kClear, place);
  return is_dim && dim == DimSample::kUnknown ? std::max(0.0, place) : place;
}

// A clear match tells 'information'; a clear mismatch weighs more, as print and light are seldom
// that wrong.
double CellEvidence(double agreement, double information) {
  constexpr double kMismatch = 3;
  const double clearness = std::min(1.0, std::abs(agreement) / kClear);
  return clearness * (agreement > 0 ? information : -kMismatch);
}

// Numbers of cells and vertices in the picture of a tag.
struct VertexCount {
  int data = 0;     // cells
  int all = 0;      // vertices where four known cells meet, data among them
  int corners = 0;  // those among them that no straight line runs through
};

VertexCount CountVertices(const TagGrid& grid, const std::vector<bool>& is_data) {
  VertexCount count;
  for (std::size_t i = 0; i < is_data.size(); ++i) {
    count.data += is_data[i] && grid.cells[i] != TagCell::kNone;
  }
  for (int row = 1; row < grid.width; ++row) {
    for (int column = 1; column < grid.width; ++column) {
      const int last = row * grid.width + column;
      const std::array<int, 4> around{last - grid.width - 1, last - grid.width, last - 1, last};
      bool has_data = false, is_known = true;
      for (const int cell : around) {
        has_data |= is_data[cell];
        is_known &= grid.cells[cell] != TagCell::kNone;
      }
      if (!has_data || !is_known) continue;
      const auto [a, b, c, d] = around;
      const bool straight = (grid.cells[a] == grid.cells[b] && grid.cells[c] == grid.cells[d]) ||
                            (grid.cells[a] == grid.cells[c] && grid.cells[b] == grid.cells[d]);
      ++count.all;
      count.corners += !straight;
    }
  }
  return count;
}

}  // namespace

double CellInformation(const TagGrid& grid, const std::vector<bool>& is_data) {
  // Before any is seen, of five vertices one is thought to be a corner.
  constexpr double kPriorCorners = 1, kPriorVertices = 5;
  const VertexCount count = CountVertices(grid, is_data);
  const double share = (count.corners + kPriorCorners) / (count.all + kPriorVertices);
  const double by_corners = -share * std::log(share) - (1 - share) * std::log(1 - share);
  // A figure of straight edges has as many of them as corners, each on a line of the grid.
  const double by_edges = count.corners * std::log(grid.border_width - 1) / std::max(1, count.data);
  return std::min(by_corners, by_edges);
}

TagAgreement CompareCells(const TagGrid& grid, const std::vector<bool>& is_data, double cell_px,
                          std::span<const float> gray, DimSample dim) {
  constexpr double kBorderWeight = 0.1;   // for a mismatch: what surrounds a tag may be anything
  constexpr double kCorrelationPx = 1.5;  // nearer samples are alike by lens and pixels
  constexpr float kFloor = 4;             // gray values: what darkness and noise leave
  std::array<float, kMostCells> log;
  for (std::size_t i = 0; i < std::min(gray.size(), kMostCells); ++i) {
    log[i] = std::log(std::max(0.0f, gray[i]) + kFloor);
  }
  const double shaded_white = ShadedWhite(grid, is_data, gray, log);
  const double apart = std::min(1.0, cell_px / kCorrelationPx);
  const double information = apart * apart * CellInformation(grid, is_data);
  TagAgreement agreement;
  for (int row = 0; row < grid.width; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const int i = row * grid.width + column;
      if (grid.cells[i] == TagCell::kNone || gray[i] < 0) continue;
      const double here = CellAgreement(grid, gray, log, shaded_white, column, row, dim);
      if (!is_data[i]) {  // alike in all tags and in windows: a match tells nothing
        agreement.evidence += kBorderWeight * CellEvidence(here, 0);
        continue;
      }
      agreement.evidence += CellEvidence(here, information);
      ++agreement.seen;
      agreement.wrong += here < 0;
    }
  }
  return agreement;
}

}  // namespace kestrel
