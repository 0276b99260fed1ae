// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/print/tiling.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

struct Paper {
  const char* name;
  double width_m;
  double height_m;
};
constexpr std::array kPapers{Paper{"a0", 0.841, 1.189}, Paper{"a1", 0.594, 0.841},
                             Paper{"a2", 0.420, 0.594}, Paper{"a3", 0.297, 0.420},
                             Paper{"a4", 0.210, 0.297}};
constexpr double kMargin_m = 0.010;       // left, right and above
constexpr double kLowerMargin_m = 0.015;  // with a line of text
constexpr int kMaxSheets = 1000;

// Returns the part of a sheet that a printer reaches, without the lines of text.
Eigen::Vector2d RoomOn(const Eigen::Vector2d& sheet) {
  return sheet - Eigen::Vector2d(2 * kMargin_m, kMargin_m + kLowerMargin_m);
}

Eigen::Vector2d PlaceOnSheet(const Eigen::Vector2d& tile, const Eigen::Vector2d& sheet) {
  return {0.5 * (sheet.x() - tile.x()), kMargin_m};
}

Tiling TileOver(double board_size_m, const Eigen::Vector2d& sheet) {
  const Eigen::Array2d count = (board_size_m / RoomOn(sheet).array()).ceil();
  Tiling tiling;
  tiling.sheet = sheet;
  tiling.tile = board_size_m / count;
  tiling.tile_on_sheet = PlaceOnSheet(tiling.tile, sheet);
  if (!(count.prod() <= kMaxSheets)) {
    throw InputError(fmt::format(
        "a board of {:.4g} m takes {} sheets of this paper, expected at most {}: take a larger one",
        board_size_m, count.prod(), kMaxSheets));
  }
  tiling.columns = static_cast<int>(count.x());
  tiling.rows = static_cast<int>(count.y());
  return tiling;
}

}  // namespace

std::vector<std::string> PaperNames() {
  std::vector<std::string> names;
  for (const Paper& paper : kPapers) names.emplace_back(paper.name);
  return names;
}

std::optional<Eigen::Vector2d> PaperSize(std::string_view name) {
  for (const Paper& paper : kPapers) {
    if (name == paper.name) return Eigen::Vector2d(paper.width_m, paper.height_m);
  }
  return std::nullopt;
}

Tiling TileBoard(double board_size_m, const Eigen::Vector2d& paper) {
  const Tiling upright = TileOver(board_size_m, paper);
  const Tiling on_its_side = TileOver(board_size_m, paper.reverse());
  return on_its_side.count() < upright.count() ? on_its_side : upright;
}

std::optional<Tiling> OneSheet(double board_size_m, double ink_m, const Eigen::Vector2d& paper) {
  const Eigen::Vector2d room = RoomOn(paper);
  if (ink_m > room.minCoeff()) return std::nullopt;
  Tiling sheet;
  sheet.sheet = paper;
  sheet.tile = room.cwiseMin(board_size_m);
  sheet.tile_on_sheet = PlaceOnSheet(sheet.tile, paper);
  sheet.first_tile = 0.5 * (Eigen::Vector2d::Constant(board_size_m) - sheet.tile);
  sheet.rows = sheet.columns = 1;
  return sheet;
}

}  // namespace kestrel
