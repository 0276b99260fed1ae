// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/plain_tags.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/vision/tags/board_model.h"
#include "kestrel/vision/tags/cell_agreement.h"

namespace kestrel {
namespace {

// Natural logarithm. A picture that tells less is not believed where no tag is expected.
constexpr double kPlainInformation = 9;

double InformationOf(const TagGrid& grid, const std::vector<bool>& is_data) {
  int data = 0;
  for (std::size_t i = 0; i < is_data.size(); ++i) {
    data += is_data[i] && grid.cells[i] != TagCell::kNone;
  }
  return data * CellInformation(grid, is_data);
}

// Returns the ids whose pictures tell most.
std::vector<int> BestIds(const TagFamily& family, const std::vector<bool>& is_data) {
  std::vector<std::pair<double, int>> ranked;  // negative: the most first, then the lowest id
  for (int id = 0; id < family.id_count(); ++id) {
    ranked.emplace_back(-InformationOf(family.Grid(id), is_data), id);
  }
  constexpr std::size_t kMost = 3;
  const std::size_t count = std::min(kMost, ranked.size());
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count),
                    ranked.end());
  std::vector<int> ids;
  for (std::size_t i = 0; i < count; ++i) ids.push_back(ranked[i].second);
  return ids;
}

}  // namespace

std::vector<std::string> WarningsOfPlainTags(const TagBoard& board) {
  std::vector<std::string> warnings;
  const BoardModel model(board);
  for (std::size_t i = 0; i < board.tags.size(); ++i) {
    const BoardTag& tag = board.tags[i];
    const std::vector<bool>& is_data = model.tags[i].is_data;
    if (InformationOf(tag.Grid(), is_data) >= kPlainInformation) continue;
    std::string warning = fmt::format(
        "{} id {} is as plain as a window, a letter or a button: a single image does not tell it "
        "from them, so it is hardly found before a track expects it",
        tag.family, tag.id);
    if (tag.IsOfFamily()) {
      warning += fmt::format("; ids that are told apart: {}",
                             fmt::join(BestIds(TagFamily(tag.family), is_data), ", "));
    }
    warnings.push_back(std::move(warning));
  }
  return warnings;
}

}  // namespace kestrel
