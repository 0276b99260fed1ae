// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/target/closed_lines.h"

#include <cmath>
#include <numbers>

namespace kestrel {

std::vector<Eigen::Vector3d> ClosedLine(const std::vector<Eigen::Vector2d>& corners) {
  constexpr int kPiecesPerSide = 8;
  std::vector<Eigen::Vector3d> line;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d& from = corners[i];
    const Eigen::Vector2d side = corners[(i + 1) % corners.size()] - from;
    for (int k = 0; k < kPiecesPerSide; ++k) {
      const Eigen::Vector2d point = from + side * k / kPiecesPerSide;
      line.emplace_back(point.x(), point.y(), 0);
    }
  }
  return line;
}

std::vector<Eigen::Vector3d> CircleLine(double radius_m) {
  constexpr int kPieces = 96;
  std::vector<Eigen::Vector3d> line;
  for (int i = 0; i < kPieces; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPieces;
    line.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle), 0);
  }
  return line;
}

}  // namespace kestrel
