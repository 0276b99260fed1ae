// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/tag_match.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/Geometry>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/tags/square_pose.h"

namespace kestrel {
namespace {

constexpr double kLeastTagContrast = 6;  // gray values between white and black cells
constexpr double kMostWrongShare = 0.2;  // among data cells, before the corners are refined

// Gray values of a tag's cells under one of the four turns, against its bits.
struct TurnedMatch {
  double wrong_share = 1;
  double contrast = 0;
};

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
  // The second threshold is right under the edge of a shadow, whose white is darker than the
  // middle.
  const double thresholds[] = {0.5 * (black + white), std::sqrt(std::max(0.0, black * white))};
  int wrong[] = {0, 0};
  int seen = 0;
  for_each_cell([&](int cell, bool is_white, float value) {
    if (!tag.is_data[cell]) return;
    ++seen;
    for (int i = 0; i < 2; ++i) wrong[i] += (value > thresholds[i]) != is_white;
  });
  const int fewest = std::min(wrong[0], wrong[1]);
  return {seen > 0 ? static_cast<double>(fewest) / seen : 1, white - black};
}

}  // namespace

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

std::span<const float> ReadQuad(const cv::Mat& image, const CameraModel& camera,
                                const Eigen::Matrix3d& homography, double side_px,
                                const TagGrid& grid, PadSamples* samples) {
  samples->Clear();
  const double middle = 0.5 * grid.width;
  for (int row = 0; row < grid.width; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      samples->Add(homography * Eigen::Vector3d((column + 0.5 - middle) / grid.border_width,
                                                (middle - row - 0.5) / grid.border_width, 1));
    }
  }
  samples->Project(camera);
  return samples->ReadCells(image, grid.width, side_px / grid.border_width);
}

std::optional<TagMatch> MatchTag(const cv::Mat& image, const CameraModel& camera,
                                 const BoardModel& board, const TagQuad& quad,
                                 PadSamples* samples) {
  const std::optional<Eigen::Matrix3d> homography = HomographyOfSquare(quad.corners);
  if (!homography) return std::nullopt;
  const TagModel* best = nullptr;
  int best_turn = 0;
  TurnedMatch best_match{.wrong_share = kMostWrongShare};
  const TagGrid* read = nullptr;
  std::span<const float> gray;
  for (const TagModel& tag : board.tags) {
    if (tag.dark_inside != quad.dark_inside) continue;
    const TagGrid& grid = tag.grid();
    if (read == nullptr || read->width != grid.width || read->border_width != grid.border_width) {
      gray = ReadQuad(image, camera, *homography, quad.side_px, grid, samples);
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
  const std::optional<RigidTransform> square = PoseOfSquare(quad.corners, *homography);
  if (!square) return std::nullopt;
  const RigidTransform square_from_tag{
      Eigen::Quaterniond(Eigen::AngleAxisd(-best_turn * kPi / 2, Eigen::Vector3d::UnitZ())),
      Eigen::Vector3d::Zero()};
  RigidTransform camera_from_tag = *square * square_from_tag;
  camera_from_tag.translation *= best->size_m;
  return TagMatch{best, camera_from_tag * best->board_from_tag.Inverse()};
}

}  // namespace kestrel
