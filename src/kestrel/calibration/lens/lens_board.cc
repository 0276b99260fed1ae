// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/lens_board.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"

namespace kestrel {
namespace {

constexpr double kMaxSide_m = 10;  // more was meant in millimetres

[[noreturn]] void Refuse(const std::string& text, const std::string& expected) {
  throw InputError(fmt::format("board '{}': expected {}", text, expected));
}

std::vector<std::string> Split(const std::string& text, char at) {
  std::vector<std::string> parts{""};
  for (const char letter : text) {
    if (letter == at) {
      parts.emplace_back();
    } else {
      parts.back() += letter;
    }
  }
  return parts;
}

// The words of a board's text.
class BoardText {
 public:
  BoardText(const std::string& text, const std::string& expected)
      : text_(text), expected_(expected), words_(Split(text, ':')) {}

  void RequireWords(std::size_t least, std::size_t most) const {
    if (words_.size() < least || words_.size() > most) Refuse(text_, expected_);
  }
  std::size_t count() const { return words_.size(); }
  const std::string& word(std::size_t i) const { return words_[i]; }

  void ReadGrid(int least, LensBoard* board) const {
    const std::vector<std::string> sides = Split(words_[1], 'x');
    const auto columns = ParseNumber<int>(sides.front());
    const auto rows = ParseNumber<int>(sides.back());
    constexpr int kMost = 100;
    if (sides.size() != 2 || !columns || !rows || std::min(*columns, *rows) < least ||
        std::max(*columns, *rows) > kMost) {
      Refuse(text_, fmt::format("a number of columns and rows from {} to {}, as 9x6, not '{}'",
                                least, kMost, words_[1]));
    }
    board->columns = *columns;
    board->rows = *rows;
  }

  // 'most': excluded.
  double Number(std::size_t word, const std::string& what, double most) const {
    const auto number = ParseNumber<double>(words_[word]);
    if (!number || !(*number > 0) || !(*number < most)) {
      Refuse(text_, fmt::format("{} above 0 and below {:g}, not '{}'", what, most, words_[word]));
    }
    return *number;
  }

 private:
  std::string text_, expected_;
  std::vector<std::string> words_;
};

// "DICT_4X4_50" and "DICT_APRILTAG_36h11" are OpenCV's names.
std::string FamilyNamed(const std::string& text, const std::string& name) {
  std::string family;
  for (const char letter : name) family += static_cast<char>(std::tolower(letter));
  constexpr std::string_view kDict = "dict_", kAprilTag = "apriltag_";
  if (family.starts_with(kDict)) {
    family.erase(0, kDict.size());
    const bool is_april = family.starts_with(kAprilTag);
    if (is_april) family.erase(0, kAprilTag.size());
    family.insert(0, is_april ? "tag" : "aruco_");
  }
  for (const std::string& known : TagFamily::Names()) {
    std::string lower;
    for (const char letter : known) lower += static_cast<char>(std::tolower(letter));
    if (lower == family) return known;
  }
  Refuse(text, "a dictionary as DICT_4X4_50 or aruco_4x4_50, not '" + name + "'");
}

void RequireIds(const std::string& text, const LensBoard& board) {
  const auto tags = static_cast<int>(board.Tags().tags.size());
  const int known = TagFamily(board.family).id_count();
  if (tags <= known) return;
  Refuse(text,
         fmt::format("at most {} tags, as many as {} has, not {}", known, board.family, tags));
}

LensBoard ParseChessboard(const std::string& text) {
  const BoardText words(text, "chessboard:COLUMNSxROWS:SQUARE, inner corners and m");
  words.RequireWords(3, 3);
  LensBoard board{.kind = LensBoardKind::kChessboard};
  words.ReadGrid(3, &board);
  board.side_m = words.Number(2, "the side of a square (m)", kMaxSide_m);
  return board;
}

LensBoard ParseCharuco(const std::string& text) {
  const BoardText words(text, "charuco:COLUMNSxROWS:SQUARE:MARKER[:DICTIONARY], squares and m");
  words.RequireWords(4, 5);
  LensBoard board{.kind = LensBoardKind::kCharuco};
  words.ReadGrid(3, &board);
  board.side_m = words.Number(2, "the side of a square (m)", kMaxSide_m);
  board.marker_m = words.Number(3, "the side of a marker (m)", board.side_m);
  board.family = FamilyNamed(text, words.count() == 5 ? words.word(4) : "aruco_4x4_50");
  RequireIds(text, board);
  return board;
}

LensBoard ParseAprilGrid(const std::string& text) {
  const BoardText words(text, "aprilgrid:COLUMNSxROWS:TAG:GAP, tags, m, and gap over tag");
  words.RequireWords(4, 4);
  LensBoard board{.kind = LensBoardKind::kAprilGrid};
  words.ReadGrid(1, &board);
  board.side_m = words.Number(2, "the side of a tag (m)", kMaxSide_m);
  board.gap = words.Number(3, "the gap between tags over their side", 2);
  RequireIds(text, board);
  return board;
}

BoardTag TagAt(const LensBoard& board, int id, double size_m, double x_m, double y_m) {
  BoardTag tag;
  tag.family = board.family;
  tag.id = id;
  tag.size_m = size_m;
  tag.board_from_tag.translation = {x_m, y_m, 0};
  return tag;
}

}  // namespace

TagBoard LensBoard::Tags() const {
  TagBoard board;
  if (kind == LensBoardKind::kChessboard) return board;
  const bool is_grid = kind == LensBoardKind::kAprilGrid;
  const double step_m = is_grid ? side_m * (1 + gap) : side_m;
  const int white = begins_white ? 0 : 1;  // parity of the squares with a marker
  int id = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (!is_grid && (row + column) % 2 != white) continue;
      const double x_m = (column - 0.5 * (columns - 1)) * step_m;
      const double y_m = (row - 0.5 * (rows - 1)) * step_m;
      // An AprilGrid is numbered from its lower left tag, a ChArUco board from its upper left.
      board.tags.push_back(
          TagAt(*this, id++, is_grid ? side_m : marker_m, x_m, is_grid ? y_m : -y_m));
    }
  }
  return board;
}

std::vector<Eigen::Vector2d> LensBoard::Corners() const {
  std::vector<Eigen::Vector2d> corners;
  if (kind == LensBoardKind::kAprilGrid) return corners;
  const int less = kind == LensBoardKind::kCharuco ? 1 : 0;
  for (int row = 0; row < rows - less; ++row) {
    for (int column = 0; column < columns - less; ++column) {
      corners.emplace_back((column - 0.5 * (columns - less - 1)) * side_m,
                           (0.5 * (rows - less - 1) - row) * side_m);
    }
  }
  return corners;
}

Eigen::Vector2d LensBoard::Size() const {
  const Eigen::Vector2d count(columns, rows);
  if (kind == LensBoardKind::kCharuco) return side_m * count;
  if (kind == LensBoardKind::kChessboard) return side_m * (count + Eigen::Vector2d::Ones());
  return side_m * ((1 + gap) * count + Eigen::Vector2d::Constant(gap));
}

LensBoard ParseLensBoard(const std::string& text) {
  const std::string kind = text.substr(0, text.find(':'));
  if (kind == "chessboard") return ParseChessboard(text);
  if (kind == "charuco") return ParseCharuco(text);
  if (kind == "aprilgrid") return ParseAprilGrid(text);
  Refuse(text,
         "chessboard:9x6:0.025, charuco:7x5:0.04:0.03 or aprilgrid:6x6:0.088:0.3 (lengths in m)");
}

}  // namespace kestrel
