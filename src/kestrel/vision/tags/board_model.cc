// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/board_model.h"

#include <algorithm>
#include <array>
#include <utility>

namespace kestrel {
namespace {

// Adds the edge between two cells that lie beside each other: from (column, row) by 'step'.
void AddEdge(int column, int row, std::pair<int, int> step, TagModel* tag) {
  const TagGrid& grid = tag->grid();
  const auto [right, down] = step;
  if (column + right >= grid.width || row + down >= grid.width) return;
  const TagCell cell = grid.at(column, row);
  const TagCell next = grid.at(column + right, row + down);
  if (cell == TagCell::kNone || next == TagCell::kNone || cell == next) return;
  const Eigen::Vector2d middle(column + 0.5 + 0.5 * right, row + 0.5 + 0.5 * down);
  const Eigen::Vector2d along(down, right);
  const double sign = next == TagCell::kWhite ? 1 : -1;
  const PrintedTag& printed = tag->printed;
  const Eigen::Vector2d to_white =
      sign * (printed.OnBoard(middle.x() + 0.5 * right, middle.y() + 0.5 * down) -
              printed.OnBoard(middle.x() - 0.5 * right, middle.y() - 0.5 * down));
  constexpr std::array<double, 3> kAlong{0, -0.3, 0.3};  // cells
  for (const double offset : kAlong) {
    const Eigen::Vector2d place = middle + offset * along;
    tag->edges.push_back({printed.OnBoard(place.x(), place.y()), to_white.normalized(),
                          printed.cell_m, offset != 0});
  }
}

TagModel MakeTag(const BoardTag& tag, const PrintedTag& printed) {
  TagModel model;
  model.id = tag.id;
  model.size_m = tag.size_m;
  model.center = printed.center;
  model.stroke_m = printed.cell_m;
  model.printed = printed;
  model.board_from_tag = tag.board_from_tag;
  const TagGrid& grid = model.grid();
  const int margin = grid.margin();
  model.dark_inside = tag.Grid().at(margin, margin) == TagCell::kBlack;
  for (int row = 0; row < grid.width; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      model.cell_centers.push_back(printed.OnBoard(column + 0.5, row + 0.5));
      model.is_data.push_back(grid.IsDataCell(column, row));
      AddEdge(column, row, {1, 0}, &model);
      AddEdge(column, row, {0, 1}, &model);
    }
  }
  int bits = 0;
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    bits += model.is_data[i] && grid.cells[i] != TagCell::kNone;
  }
  model.most_wrong = MostWrongBits(tag.MinDistance(), bits);
  return model;
}

}  // namespace

BoardModel::BoardModel(const TagBoard& board) {
  const std::vector<PrintedTag> printed = board.Printed();
  for (std::size_t i = 0; i < printed.size(); ++i) {
    tags.push_back(MakeTag(board.tags[i], printed[i]));
    const TagModel& tag = tags.back();
    most_cells = std::max(most_cells, tag.cell_count());
    const double width = tag.grid().width;
    for (const auto& [column, row] :
         {std::pair(0.0, 0.0), {width, 0.0}, {width, width}, {0.0, width}}) {
      radius_m = std::max(radius_m, printed[i].OnBoard(column, row).norm());
    }
  }
}

}  // namespace kestrel
