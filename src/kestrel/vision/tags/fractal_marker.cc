// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/fractal_marker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

#include "kestrel/core/base/yaml_reader.h"

namespace kestrel {
namespace {

constexpr int kMostMarkers = 8;
constexpr int kLeastSide = 3, kMostSide = 32;  // bits
constexpr double kSquareTolerance = 1e-3;      // as a share of a square's side

enum FractalUnit { kPixels = 0, kMetres = 1, kHalfSides = 2 };

// A square in the file's unit.
struct MarkerSquare {
  Eigen::Vector2d center;
  double side;

  // Returns whether it and another one have more than an edge in common.
  bool Overlaps(const MarkerSquare& other) const {
    const double reach = 0.5 * (side + other.side) - kSquareTolerance * std::min(side, other.side);
    return (center - other.center).lpNorm<Eigen::Infinity>() < reach;
  }
};

struct FractalLevel {
  BoardTag tag;
  MarkerSquare square;
};

// OpenCV writes "{ id:0, bits:[ 1 ] }", which is no YAML without a space.
std::string WithSpaces(std::string_view text) {
  constexpr std::array<std::string_view, 4> kKeys{"id:", "bits:", "corners:", "submarkers_id:"};
  std::string spaced;
  for (std::size_t i = 0; i < text.size(); ++i) {
    spaced += text[i];
    const std::string_view before = text.substr(0, i + 1);
    if (std::any_of(kKeys.begin(), kKeys.end(),
                    [&](std::string_view key) { return before.ends_with(key); })) {
      spaced += ' ';
    }
  }
  return spaced;
}

TagGrid ReadBits(const YamlReader& list) {
  std::vector<bool> bits;
  for (const YamlReader& item : list.Items()) {
    const std::int64_t bit = item.Integer();
    if (bit != 0 && bit != 1) item.Fail(fmt::format("is {}, expected 0 or 1", bit));
    bits.push_back(bit == 1);
  }
  const int side = static_cast<int>(std::lround(std::sqrt(static_cast<double>(bits.size()))));
  if (side < kLeastSide || side > kMostSide ||
      bits.size() != static_cast<std::size_t>(side) * side) {
    list.Fail(fmt::format("has {} bits, expected a square of {} x {} to {} x {}", bits.size(),
                          kLeastSide, kLeastSide, kMostSide, kMostSide));
  }
  return SquareTag(side, bits);
}

MarkerSquare ReadCorners(const YamlReader& list) {
  constexpr std::size_t kCorners = 4;
  const std::vector<YamlReader> items = list.Items();
  if (items.size() != kCorners) {
    list.Fail(fmt::format("has {} corners, expected {}", items.size(), kCorners));
  }
  std::array<Eigen::Vector3d, kCorners> corners;
  for (std::size_t i = 0; i < kCorners; ++i) {
    const std::vector<double> place = items[i].Numbers(3);
    corners[i] = {place[0], place[1], place[2]};
  }
  const double side = corners[1].x() - corners[0].x();
  const Eigen::Vector3d center = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  const std::array<Eigen::Vector2d, kCorners> turns{
      {{-0.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}, {-0.5, -0.5}}};
  for (std::size_t i = 0; i < kCorners; ++i) {
    const Eigen::Vector3d expected = center + side * Eigen::Vector3d(turns[i].x(), turns[i].y(), 0);
    if (!(side > 0) || !((corners[i] - expected).norm() <= kSquareTolerance * side)) {
      list.Fail(
          "are not those of an upright square, from the upper left one on, clockwise, with y up");
    }
  }
  return {center.head<2>(), side};
}

FractalLevel ReadLevel(const YamlReader& item) {
  item.RequireKeys({"id", "bits", "corners", "submarkers_id"});
  FractalLevel marker;
  marker.tag.family = "fractal";
  marker.tag.id = static_cast<int>(item["id"].Integer());
  marker.tag.own = ReadBits(item["bits"]);
  marker.square = ReadCorners(item["corners"]);
  return marker;
}

// Takes away the cells of a marker that a smaller one covers.
void Cover(const MarkerSquare& smaller, const MarkerSquare& square, TagGrid* grid) {
  const double cell = square.side / grid->border_width;
  const double middle = 0.5 * grid->width;
  for (int row = 0; row < grid->width; ++row) {
    for (int column = 0; column < grid->width; ++column) {
      const Eigen::Vector2d place(column + 0.5 - middle, middle - row - 0.5);
      if (MarkerSquare{square.center + cell * place, cell}.Overlaps(smaller)) {
        grid->cells[row * grid->width + column] = TagCell::kNone;
      }
    }
  }
}

double MetresPerUnit(const YamlReader& root, double largest, double size_m) {
  const std::int64_t unit = root["mInfoType"].Integer();
  if (unit < kPixels || unit > kHalfSides) {
    root["mInfoType"].Fail(
        fmt::format("is {}, expected 0 (pixels), 1 (metres) or 2 (half of the side)", unit));
  }
  return unit == kMetres ? 1 : size_m / largest;
}

}  // namespace

bool IsFractalMarker(std::string_view text) {
  return text.find("fractal_levels:") != std::string_view::npos;
}

TagBoard ParseFractalMarker(const std::string& text, const std::string& file, double size_m) {
  const YamlReader root(WithSpaces(text), file);
  root.RequireKeys({"codeid", "mInfoType", "fractal_levels", "fractal_external_id", "markers"});
  std::vector<FractalLevel> markers;
  for (const YamlReader& item : root["markers"].Items()) markers.push_back(ReadLevel(item));
  if (markers.empty() || markers.size() > kMostMarkers) {
    root["markers"].Fail(
        fmt::format("has {} markers, expected 1 to {}", markers.size(), kMostMarkers));
  }
  std::stable_sort(
      markers.begin(), markers.end(),
      [](const FractalLevel& a, const FractalLevel& b) { return a.square.side > b.square.side; });
  const MarkerSquare& largest = markers.front().square;
  const double scale = MetresPerUnit(root, largest.side, size_m);
  TagBoard board;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    auto& [tag, square] = markers[i];
    for (std::size_t k = i + 1; k < markers.size(); ++k) {
      Cover(markers[k].square, square, &tag.own);
    }
    tag.size_m = scale * square.side;
    tag.board_from_tag.translation.head<2>() = scale * (square.center - largest.center);
    board.tags.push_back(tag);
  }
  return board;
}

}  // namespace kestrel
