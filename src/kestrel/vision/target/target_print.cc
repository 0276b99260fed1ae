// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/target/target_print.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace kestrel {
namespace {

double Reach(const PrintRing& ring) {
  return ring.center.cwiseAbs().maxCoeff() + ring.outer_radius_m;
}

double Reach(const PrintPolygon& polygon) {
  double reach = 0;
  for (const auto& loop : polygon.loops) {
    for (const Eigen::Vector2d& corner : loop) {
      reach = std::max(reach, corner.cwiseAbs().maxCoeff());
    }
  }
  return reach;
}

double Reach(const PrintShape& shape) {
  return std::visit([](const auto& area) { return Reach(area); }, shape.area);
}

}  // namespace

PrintPolygon Rectangle(const Eigen::Vector2d& center, const Eigen::Vector2d& size) {
  const Eigen::Vector2d half = 0.5 * size;
  return {{{center + half, center + Eigen::Vector2d(half.x(), -half.y()), center - half,
            center + Eigen::Vector2d(-half.x(), half.y())}}};
}

PrintShape Moved(const PrintShape& shape, double heading, const Eigen::Vector2d& offset) {
  const Eigen::Rotation2Dd turn(heading);
  PrintShape moved = shape;
  if (PrintRing* const ring = std::get_if<PrintRing>(&moved.area)) {
    ring->center = turn * ring->center + offset;
  } else {
    for (auto& loop : std::get<PrintPolygon>(moved.area).loops) {
      for (Eigen::Vector2d& corner : loop) corner = turn * corner + offset;
    }
  }
  return moved;
}

double HalfExtent(const TargetPrint& print) {
  double extent = 0;
  for (const PrintShape& shape : print.shapes) extent = std::max(extent, Reach(shape));
  return extent;
}

double InkSize(const TargetPrint& print) {
  if (print.board_gray < 1) return print.board_size_m;
  double reach = 0;
  for (const PrintShape& shape : print.shapes) {
    if (shape.gray < 1) reach = std::max(reach, Reach(Moved(shape, print.board_heading, {0, 0})));
  }
  return 2 * reach;
}

double ReachOnBoard(const TargetPrint& print, const Eigen::Vector2d& point) {
  return (Eigen::Rotation2Dd(print.board_heading) * point).cwiseAbs().maxCoeff();
}

void PrintOver(const TargetPrint& other, TargetPrint* print) {
  const double turned = print->board_heading - other.board_heading;
  const PrintShape board{Rectangle({0, 0}, Eigen::Vector2d::Constant(other.board_size_m)), 0};
  print->board_size_m = std::max(print->board_size_m, 2 * Reach(Moved(board, turned, {0, 0})));
  print->shapes.insert(print->shapes.end(), other.shapes.begin(), other.shapes.end());
  print->dimensions.insert(print->dimensions.end(), other.dimensions.begin(),
                           other.dimensions.end());
}

}  // namespace kestrel
