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

Tiling TileOver(double board_size_m, const Eigen::Vector2d& sheet) {
  const Eigen::Vector2d room = sheet - Eigen::Vector2d(2 * kMargin_m, kMargin_m + kLowerMargin_m);
  const Eigen::Array2d count = (board_size_m / room.array()).ceil();
  Tiling tiling;
  tiling.sheet = sheet;
  tiling.tile = board_size_m / count;
  tiling.tile_on_sheet = {0.5 * (sheet.x() - tiling.tile.x()), kMargin_m};
  if (!(count.prod() <= kMaxSheets)) {
    throw InputError(fmt::format(
        "a board of {} m takes {} sheets of this paper, expected at most {}: take a larger one",
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

}  // namespace kestrel
