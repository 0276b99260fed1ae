// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/tag_family.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <string>
#include <string_view>

#include <apriltag/apriltag.h>
#include <fmt/format.h>

#include "kestrel/core/base/edit_distance.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/shown.h"
#include "kestrel/vision/tags/apriltag_families.h"
#include "kestrel/vision/tags/aruco_codes.h"

namespace kestrel {
namespace {

struct ArucoFamily {
  std::string_view name;
  int side;  // bits
  int id_count;
  int corrected_bits;  // as OpenCV says: fewer than half of those that differ
};

constexpr std::string_view kArucoOriginal = "aruco_original";
constexpr std::array<ArucoFamily, 17> kArucoFamilies{{
    {"aruco_4x4_50", 4, 50, 1},
    {"aruco_4x4_100", 4, 100, 1},
    {"aruco_4x4_250", 4, 250, 1},
    {"aruco_4x4_1000", 4, 1000, 0},
    {"aruco_5x5_50", 5, 50, 3},
    {"aruco_5x5_100", 5, 100, 3},
    {"aruco_5x5_250", 5, 250, 2},
    {"aruco_5x5_1000", 5, 1000, 2},
    {"aruco_6x6_50", 6, 50, 6},
    {"aruco_6x6_100", 6, 100, 5},
    {"aruco_6x6_250", 6, 250, 5},
    {"aruco_6x6_1000", 6, 1000, 4},
    {"aruco_7x7_50", 7, 50, 9},
    {"aruco_7x7_100", 7, 100, 8},
    {"aruco_7x7_250", 7, 250, 8},
    {"aruco_7x7_1000", 7, 1000, 6},
    {kArucoOriginal, 5, 1024, 0},
}};

// Paints the cells on the edge of a centred square.
void PaintSquare(int side, TagCell cell, TagGrid* grid) {
  const int first = (grid->width - side) / 2;
  const int last = first + side - 1;
  for (int i = first; i <= last; ++i) {
    for (const int edge : {first, last}) {
      grid->cells[edge * grid->width + i] = cell;
      grid->cells[i * grid->width + edge] = cell;
    }
  }
}

void Invert(TagGrid* grid) {
  for (TagCell& cell : grid->cells) {
    if (cell == TagCell::kNone) continue;
    cell = cell == TagCell::kBlack ? TagCell::kWhite : TagCell::kBlack;
  }
}

TagGrid Turned(const TagGrid& grid) {
  TagGrid turned = grid;
  for (int row = 0; row < grid.width; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      turned.cells[row * grid.width + column] = grid.at(row, grid.width - 1 - column);
    }
  }
  return turned;
}

// Returns the name here of a family that is named as OpenCV does: "DICT_4X4_50", "4x4_50",
// "DICT_APRILTAG_36h11".
std::string OwnName(const std::string& name) {
  constexpr std::string_view kPrefix = "dict_", kAprilTag = "apriltag_";
  std::string plain = name;
  for (char& c : plain) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool has_prefix = plain.starts_with(kPrefix);
  if (has_prefix) plain.erase(0, kPrefix.size());
  if (plain.starts_with(kAprilTag)) return "tag" + plain.substr(kAprilTag.size());
  const bool is_square =
      plain.size() > 1 && std::isdigit(static_cast<unsigned char>(plain[0])) && plain[1] == 'x';
  if (is_square) return "aruco_" + plain;
  return has_prefix ? plain : name;
}

}  // namespace

bool TagGrid::IsDataCell(int column, int row) const {
  // Number of the ring from the outside.
  const int ring = std::min(std::min(column, row), width - 1 - std::max(column, row));
  return ring != margin() && ring != margin() - 1;
}

int MostWrongBits(int min_distance, int bits) {
  constexpr int kBitsPerWrong = 18;
  return std::min((min_distance - 1) / 2, bits / kBitsPerWrong);
}

TagGrid SquareTag(int side, const std::vector<bool>& bits) {
  const int width = side + 4;
  TagGrid grid{width, side + 2, std::vector<TagCell>(width * width, TagCell::kNone)};
  PaintSquare(grid.border_width, TagCell::kBlack, &grid);
  PaintSquare(width, TagCell::kWhite, &grid);
  for (int i = 0; i < side * side; ++i) {
    grid.cells[(i / side + 2) * width + i % side + 2] = bits[i] ? TagCell::kWhite : TagCell::kBlack;
  }
  return grid;
}

int TurnDistance(const TagGrid& grid) {
  int least = static_cast<int>(grid.cells.size());
  TagGrid turned = grid;
  for (int turn = 1; turn < 4; ++turn) {
    turned = Turned(turned);
    int differing = 0;
    for (std::size_t i = 0; i < grid.cells.size(); ++i) {
      differing += grid.cells[i] != turned.cells[i] && grid.cells[i] != TagCell::kNone &&
                   turned.cells[i] != TagCell::kNone;
    }
    least = std::min(least, differing);
  }
  return least;
}

const std::vector<std::string>& TagFamily::Names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const AprilTagFamily& family : AprilTagFamilies()) all.emplace_back(family.name);
    for (const ArucoFamily& family : kArucoFamilies) all.emplace_back(family.name);
    return all;
  }();
  return names;
}

TagFamily::TagFamily(const std::string& name) : name_(OwnName(name)) {
  const auto aruco = std::find_if(kArucoFamilies.begin(), kArucoFamilies.end(),
                                  [&](const ArucoFamily& family) { return family.name == name_; });
  if (aruco != kArucoFamilies.end()) {
    ReadAruco(aruco->side, aruco->id_count, aruco->corrected_bits);
  } else {
    ReadAprilTag();
  }
}

void TagFamily::ReadAprilTag() {
  const AprilTagFamily* const known = FindAprilTagFamily(name_);
  if (known == nullptr) {
    throw InputError(fmt::format("unknown family of tags '{}', did you mean '{}'?", Shown(name_),
                                 NearestName(name_, Names())));
  }
  const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family(known->create(),
                                                                                known->destroy);
  width_ = family->total_width;
  border_width_ = family->width_at_border;
  white_inside_ = family->reversed_border;
  min_distance_ = static_cast<int>(family->h);
  const int margin = (width_ - border_width_) / 2;
  for (std::uint32_t i = 0; i < family->nbits; ++i) {
    // The places count from the edge of the square, and may be negative.
    bits_.push_back(
        {static_cast<int>(family->bit_x[i]) + margin, static_cast<int>(family->bit_y[i]) + margin});
  }
  codes_.assign(family->codes, family->codes + family->ncodes);
}

void TagFamily::ReadAruco(int side, int id_count, int corrected_bits) {
  border_width_ = side + 2;
  width_ = border_width_ + 2;
  min_distance_ = 2 * corrected_bits + 1;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) bits_.push_back({column + 2, row + 2});
  }
  const bool is_original = name_ == kArucoOriginal;
  for (int id = 0; id < id_count; ++id) {
    codes_.push_back(is_original ? OriginalArucoCode(id) : ArucoCodes(side)[id]);
  }
}

TagGrid TagFamily::Grid(int id, bool inverted) const {
  if (id < 0 || id >= id_count()) {
    throw InputError(fmt::format("{} has no id {}, expected 0 to {}", name_, id, id_count() - 1));
  }
  TagGrid grid{width_, border_width_, std::vector<TagCell>(width_ * width_, TagCell::kNone)};
  PaintSquare(border_width_, white_inside_ ? TagCell::kWhite : TagCell::kBlack, &grid);
  PaintSquare(border_width_ + 2, white_inside_ ? TagCell::kBlack : TagCell::kWhite, &grid);
  for (std::size_t i = 0; i < bits_.size(); ++i) {
    const bool white = codes_[id] >> (bits_.size() - 1 - i) & 1;
    grid.cells[bits_[i].row * width_ + bits_[i].column] = white ? TagCell::kWhite : TagCell::kBlack;
  }
  if (inverted) Invert(&grid);
  return grid;
}

}  // namespace kestrel
