// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/tag_match.h"

#include <array>
#include <cmath>
#include <span>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr double kLeastTagContrast = 6;  // gray values between white and black cells
constexpr double kMostWrongShare = 0.2;  // of the data cells, before the corners are refined

// Gray values of a tag's cells under one of the four turns, against its bits.
struct TurnedMatch {
  double wrong_share = 1;
  double contrast = 0;
};

// Index, in the grid of a quad, of a tag's cell when the tag's first corner is the quad's corner
// 'turn', clockwise.
int TurnedIndex(int column, int row, int turn, int width) {
  const int last = width - 1;
  switch (turn) {
    case 0:
      return row * width + column;
    case 1:
      return column * width + last - row;
    case 2:
      return (last - row) * width + last - column;
    default:
      return (last - column) * width + row;
  }
}

TurnedMatch Compare(const TagModel& tag, int turn, std::span<const float> gray) {
  const TagGrid& grid = tag.grid();
  double sum[2] = {0, 0};
  int count[2] = {0, 0};
  const auto for_each_cell = [&](const auto& visit) {
    for (int row = 0; row < grid.width; ++row) {
      for (int column = 0; column < grid.width; ++column) {
        const TagCell cell = grid.at(column, row);
        const float value = gray[TurnedIndex(column, row, turn, grid.width)];
        if (cell == TagCell::kNone || value < 0) continue;
        visit(row * grid.width + column, cell == TagCell::kWhite, value);
      }
    }
  };
  for_each_cell([&](int, bool white, float value) {
    sum[white] += value;
    ++count[white];
  });
  if (count[0] == 0 || count[1] == 0) return {};
  const double black = sum[0] / count[0];
  const double white = sum[1] / count[1];
  int wrong = 0, seen = 0;
  for_each_cell([&](int cell, bool is_white, float value) {
    if (!tag.is_data[cell]) return;
    ++seen;
    wrong += (value > 0.5 * (black + white)) != is_white;
  });
  return {seen > 0 ? static_cast<double>(wrong) / seen : 1, white - black};
}

// Samples the cells of a grid that a quad is the square of.
std::span<const float> ReadGrid(const cv::Mat& image, const CameraModel& camera,
                                const RigidTransform& camera_from_square, double side_px,
                                const TagGrid& grid, BoardSamples* samples) {
  samples->Clear();
  const double middle = 0.5 * grid.width;
  for (int row = 0; row < grid.width; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      samples->Add(camera_from_square * Eigen::Vector3d((column + 0.5 - middle) / grid.border_width,
                                                        (middle - row - 0.5) / grid.border_width,
                                                        0));
    }
  }
  samples->Project(camera);
  return samples->ReadCells(image, grid.width, side_px / grid.border_width);
}

}  // namespace

std::optional<RigidTransform> PoseOfUnitSquare(const TagQuad& quad) {
  Eigen::Matrix3d camera_from_plane;
  Eigen::Vector3d sight = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : quad.corners) sight += corner;
  camera_from_plane.col(2) = sight.normalized();
  camera_from_plane.col(0) = camera_from_plane.col(2).unitOrthogonal();
  camera_from_plane.col(1) = camera_from_plane.col(2).cross(camera_from_plane.col(0));
  // The homography from the square to the plane across the sight, by its four corners.
  constexpr std::array<std::array<double, 2>, 4> kSquare{
      {{-0.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}, {-0.5, -0.5}}};
  Eigen::Matrix<double, 8, 8> equations;
  Eigen::Matrix<double, 8, 1> seen;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d corner = camera_from_plane.transpose() * quad.corners[i];
    if (corner.z() <= 0) return std::nullopt;
    const Eigen::Vector2d p = corner.hnormalized();
    const auto [x, y] = kSquare[i];
    equations.row(2 * i) << x, y, 1, 0, 0, 0, -p.x() * x, -p.x() * y;
    equations.row(2 * i + 1) << 0, 0, 0, x, y, 1, -p.y() * x, -p.y() * y;
    seen.segment<2>(2 * i) = p;
  }
  const Eigen::Matrix<double, 8, 1> h = equations.partialPivLu().solve(seen);
  if (!h.allFinite()) return std::nullopt;
  const Eigen::Vector3d first(h[0], h[3], h[6]);
  const Eigen::Vector3d second(h[1], h[4], h[7]);
  const double scale = 2 / (first.norm() + second.norm());
  // The rotation nearest to the two columns: their bisectors are at right angles.
  const Eigen::Vector3d sum = (first.normalized() + second.normalized()).normalized();
  const Eigen::Vector3d difference = (first.normalized() - second.normalized()).normalized();
  Eigen::Matrix3d rotation;
  rotation.col(0) = (sum + difference) * M_SQRT1_2;
  rotation.col(1) = (sum - difference) * M_SQRT1_2;
  rotation.col(2) = rotation.col(0).cross(rotation.col(1));
  const Eigen::Vector3d place = scale * Eigen::Vector3d(h[2], h[5], 1);
  if (!rotation.allFinite() || rotation.col(2).dot(place) >= 0) return std::nullopt;
  return RigidTransform{Eigen::Quaterniond(camera_from_plane * rotation),
                        camera_from_plane * place};
}

std::optional<TagMatch> MatchTag(const cv::Mat& image, const CameraModel& camera,
                                 const BoardModel& board, const TagQuad& quad,
                                 BoardSamples* samples) {
  const std::optional<RigidTransform> square = PoseOfUnitSquare(quad);
  if (!square) return std::nullopt;
  const TagModel* best = nullptr;
  int best_turn = 0;
  TurnedMatch best_match{.wrong_share = kMostWrongShare};
  const TagGrid* read = nullptr;
  std::span<const float> gray;
  for (const TagModel& tag : board.tags) {
    if (tag.dark_inside != quad.dark_inside) continue;
    const TagGrid& grid = tag.grid();
    if (read == nullptr || read->width != grid.width || read->border_width != grid.border_width) {
      gray = ReadGrid(image, camera, *square, quad.side_px, grid, samples);
      read = &grid;
    }
    for (int turn = 0; turn < 4; ++turn) {
      const TurnedMatch match = Compare(tag, turn, gray);
      if (match.contrast < kLeastTagContrast || match.wrong_share > best_match.wrong_share ||
          (match.wrong_share == best_match.wrong_share && match.contrast < best_match.contrast)) {
        continue;
      }
      best = &tag;
      best_turn = turn;
      best_match = match;
    }
  }
  if (best == nullptr) return std::nullopt;
  const RigidTransform square_from_tag{
      Eigen::Quaterniond(Eigen::AngleAxisd(-best_turn * kPi / 2, Eigen::Vector3d::UnitZ())),
      Eigen::Vector3d::Zero()};
  RigidTransform camera_from_tag = *square * square_from_tag;
  camera_from_tag.translation *= best->size_m;
  return TagMatch{best, camera_from_tag * best->board_from_tag.Inverse()};
}

}  // namespace kestrel
