// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/tag_board.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/yaml_reader.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/tags/fractal_marker.h"

namespace kestrel {
namespace {

constexpr double kLargestSize = 20;       // m; beyond it the unit was millimetres
constexpr double kFlat = 0.005;           // m
constexpr double kLevel = Radians(1);     // tilt
constexpr double kPrintTolerance = 0.02;  // overlap of two cells that does not count, cells
constexpr double kMillimetre = 0.001;

// A cell on the board.
struct Square {
  Eigen::Vector2d center;
  Eigen::Vector2d x_axis;  // unit vectors along the sides
  Eigen::Vector2d y_axis;
  double half_side;
};

Square CellSquare(const PrintedTag& tag, int column, int row) {
  const Eigen::Vector2d x_axis(std::cos(tag.heading), std::sin(tag.heading));
  return {tag.OnBoard(column + 0.5, row + 0.5), x_axis, Eigen::Vector2d(-x_axis.y(), x_axis.x()),
          0.5 * tag.cell_m};
}

// True when no axis separates the squares (separating axis theorem).
bool Overlap(const Square& a, const Square& b) {
  const Eigen::Vector2d between = b.center - a.center;
  const double tolerance = kPrintTolerance * std::min(a.half_side, b.half_side);
  const std::array<Eigen::Vector2d, 4> axes{a.x_axis, a.y_axis, b.x_axis, b.y_axis};
  return std::all_of(axes.begin(), axes.end(), [&](const Eigen::Vector2d& axis) {
    const auto reach = [&](const Square& square) {
      return square.half_side *
             (std::abs(square.x_axis.dot(axis)) + std::abs(square.y_axis.dot(axis)));
    };
    return std::abs(between.dot(axis)) < reach(a) + reach(b) - tolerance;
  });
}

double OuterRadius(const PrintedTag& tag) { return tag.grid.width * tag.cell_m * M_SQRT1_2; }

// Calls 'conflict' with each cell of 'lower' (column, row) that 'upper' paints in another colour.
template <class Conflict>
void ForEachConflict(const PrintedTag& lower, const PrintedTag& upper, const Conflict& conflict) {
  if ((lower.center - upper.center).norm() > OuterRadius(lower) + OuterRadius(upper)) return;
  for (int i = 0; i < lower.grid.width * lower.grid.width; ++i) {
    const TagCell cell = lower.grid.cells[i];
    if (cell == TagCell::kNone) continue;
    const int column = i % lower.grid.width;
    const int row = i / lower.grid.width;
    const Square square = CellSquare(lower, column, row);
    for (int k = 0; k < upper.grid.width * upper.grid.width; ++k) {
      const TagCell other = upper.grid.cells[k];
      if (other == TagCell::kNone || other == cell) continue;
      if (Overlap(square, CellSquare(upper, k % upper.grid.width, k / upper.grid.width))) {
        conflict(column, row);
        break;
      }
    }
  }
}

std::string NameOf(const BoardTag& tag) { return fmt::format("{} id {}", tag.family, tag.id); }

PrintedTag Print(const BoardTag& tag) {
  PrintedTag printed;
  printed.grid = tag.Grid();
  printed.cell_m = tag.size_m / printed.grid.border_width;
  printed.center = tag.board_from_tag.translation.head<2>();
  printed.heading = HeadingOf(tag.board_from_tag.rotation);
  return printed;
}

void AddTagViolations(const BoardTag& tag, std::vector<std::string>* violations) {
  const std::string name = NameOf(tag);
  try {
    tag.Grid();
  } catch (const InputError& error) {
    violations->emplace_back(error.what());
  }
  Require(tag.size_m, MoreThan(0), name + ": size_m", violations);
  if (tag.size_m >= kLargestSize) {
    violations->push_back(fmt::format("{}: size_m is {}, expected metres: {}?", name, tag.size_m,
                                      kMillimetre * tag.size_m));
  }
  const Eigen::Vector3d& place = tag.board_from_tag.translation;
  if (!place.allFinite()) violations->push_back(name + ": its place is not finite");
  if (std::abs(place.z()) > kFlat) {
    violations->push_back(
        fmt::format("{} is not in the plane of the board: z is {} m", name, place.z()));
  }
  const Eigen::Vector3d face = tag.board_from_tag.rotation * Eigen::Vector3d::UnitZ();
  const double tilt = std::acos(std::clamp(face.z(), -1.0, 1.0));
  if (!(tilt <= kLevel)) {
    violations->push_back(fmt::format(
        "{} is not in the plane of the board: it is tilted by {:.1f} deg", name, Degrees(tilt)));
  }
}

// Returns whether 'a' is printed over 'b', or the other way round, on purpose.
bool IsOver(const BoardTag& a, const BoardTag& b) { return a.size_m < b.size_m ? a.over : b.over; }

void AddOverlaps(const std::vector<BoardTag>& tags, std::vector<std::string>* violations) {
  std::vector<PrintedTag> printed;
  for (const BoardTag& tag : tags) printed.push_back(Print(tag));
  for (std::size_t i = 0; i < tags.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (IsOver(tags[i], tags[k])) continue;
      bool conflict = false;
      ForEachConflict(printed[k], printed[i], [&](int, int) { conflict = true; });
      if (!conflict) continue;
      violations->push_back(fmt::format(
          "{} and {} overlap, expected places apart, an empty centre around the smaller "
          "one, or 'over: true' for it",
          NameOf(tags[k]), NameOf(tags[i])));
    }
  }
}

BoardTag ReadTag(const YamlReader& item, const std::string& family) {
  item.RequireKeys({"family", "id", "size_m", "x_m", "y_m", "yaw_deg", "inverted", "over"});
  const auto number = [&](const char* key) { return item.Has(key) ? item[key].Number() : 0; };
  BoardTag tag;
  tag.family = item.Has("family") ? item["family"].Text() : family;
  tag.id = static_cast<int>(item["id"].Integer());
  tag.size_m = item["size_m"].Number();
  tag.inverted = item.Has("inverted") && item["inverted"].Bool();
  tag.over = item.Has("over") && item["over"].Bool();
  tag.board_from_tag.translation = {number("x_m"), number("y_m"), 0};
  tag.board_from_tag.rotation =
      Eigen::AngleAxisd(Radians(number("yaw_deg")), Eigen::Vector3d::UnitZ());
  return tag;
}

// A tag of apriltag_ros' bundle. Its frame is that of TagFamily.
BoardTag ReadBundleTag(const YamlReader& item, const std::string& family) {
  item.RequireKeys({"id", "size", "x", "y", "z", "qw", "qx", "qy", "qz"});
  const auto number = [&](const char* key, double missing) {
    return item.Has(key) ? item[key].Number() : missing;
  };
  BoardTag tag;
  tag.family = family;
  tag.id = static_cast<int>(item["id"].Integer());
  tag.size_m = item["size"].Number();
  tag.board_from_tag.translation = {number("x", 0), number("y", 0), number("z", 0)};
  const Eigen::Quaterniond rotation(number("qw", 1), number("qx", 0), number("qy", 0),
                                    number("qz", 0));
  if (!(rotation.norm() > 0)) item.Fail("the quaternion is zero");
  tag.board_from_tag.rotation = rotation.normalized();
  return tag;
}

// A tag by itself needs no file.
constexpr const char* kOneTagAdvice =
    ": a tag by itself is no board: give its id (--target-id ID) and its size (size_m, in metres) "
    "instead of the file";

// Refuses the files of apriltag_ros that hold no board.
void RequireBoard(const YamlReader& root) {
  if (root.Has("standalone_tags") && !root.Has("tag_bundles")) {
    root["standalone_tags"].Fail(fmt::format("expected 'tags' or 'tag_bundles'{}", kOneTagAdvice));
  }
  for (const char* node : {"/**", "apriltag", "ros__parameters"}) {
    if (!root.Has(node)) continue;
    root[node].Fail(fmt::format("parameters of a ROS 2 node, expected 'tags' or 'tag_bundles'{}",
                                kOneTagAdvice));
  }
}

}  // namespace

TagGrid BoardTag::Grid() const { return IsOfFamily() ? TagFamily(family).Grid(id, inverted) : own; }

int BoardTag::MinDistance() const {
  return IsOfFamily() ? TagFamily(family).min_distance() : TurnDistance(own);
}

Eigen::Vector2d PrintedTag::OnBoard(double column, double row) const {
  const double x = cell_m * (column - 0.5 * grid.width);
  const double y = cell_m * (0.5 * grid.width - row);
  const double cosine = std::cos(heading);
  const double sine = std::sin(heading);
  return center + Eigen::Vector2d(cosine * x - sine * y, sine * x + cosine * y);
}

std::vector<std::string> TagBoard::Validate() const {
  std::vector<std::string> violations;
  if (tags.empty()) violations.emplace_back("the board has no tag");
  std::set<std::pair<std::string, int>> seen;
  for (const BoardTag& tag : tags) {
    AddTagViolations(tag, &violations);
    if (!seen.emplace(tag.family, tag.id).second) {
      violations.push_back(NameOf(tag) + " is on the board twice");
    }
  }
  if (violations.empty()) AddOverlaps(tags, &violations);
  return violations;
}

double TagBoard::LargestSize() const {
  double largest = 0;
  for (const BoardTag& tag : tags) largest = std::max(largest, tag.size_m);
  return largest;
}

TagBoard TagBoard::Scaled(double factor) const {
  TagBoard scaled = *this;
  for (BoardTag& tag : scaled.tags) {
    tag.size_m *= factor;
    tag.board_from_tag.translation *= factor;
  }
  return scaled;
}

std::vector<PrintedTag> TagBoard::Printed() const {
  std::vector<PrintedTag> printed;
  for (const BoardTag& tag : tags) printed.push_back(Print(tag));
  std::vector<PrintedTag> covered = printed;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    for (std::size_t k = 0; k < tags.size(); ++k) {
      if (tags[k].size_m >= tags[i].size_m || !tags[k].over) continue;
      ForEachConflict(printed[i], printed[k], [&](int column, int row) {
        covered[i].grid.cells[row * covered[i].grid.width + column] = TagCell::kNone;
      });
    }
  }
  return covered;
}

TagBoard ParseTagBoard(const std::string& yaml, const std::string& file, const std::string& family,
                       double size_m) {
  if (IsFractalMarker(yaml)) return ParseFractalMarker(yaml, file, size_m);
  const YamlReader root(yaml, file);
  RequireBoard(root);
  TagBoard board;
  if (root.Has("tag_bundles")) {
    root.RequireKeys({"standalone_tags", "tag_bundles"});
    const std::vector<YamlReader> bundles = root["tag_bundles"].Items();
    if (bundles.size() != 1) {
      root["tag_bundles"].Fail(fmt::format("has {} bundles, expected one{}", bundles.size(),
                                           bundles.empty() ? kOneTagAdvice : ""));
    }
    bundles[0].RequireKeys({"name", "layout"});
    for (const YamlReader& item : bundles[0]["layout"].Items()) {
      board.tags.push_back(ReadBundleTag(item, family));
    }
    return board;
  }
  root.RequireKeys({"tags"});
  for (const YamlReader& item : root["tags"].Items()) board.tags.push_back(ReadTag(item, family));
  return board;
}

TagBoard TagTargetOptions::Board() const {
  if (!board.empty()) return ParseTagBoard(ReadFile(board), board, family, size_m);
  BoardTag tag;
  tag.family = family;
  tag.id = id;
  tag.size_m = size_m;
  return {{tag}};
}

std::vector<std::string> TagTargetOptions::ValidateBoard() const {
  std::vector<std::string> violations;
  try {
    violations = Board().Validate();
    if (board.empty()) return violations;
    for (std::string& violation : violations) violation.insert(0, board + ": ");
  } catch (const InputError& error) {
    violations = {error.what()};
  }
  // The key, apart from the path that follows it.
  for (std::string& violation : violations) violation.insert(0, "board: ");
  return violations;
}

}  // namespace kestrel
