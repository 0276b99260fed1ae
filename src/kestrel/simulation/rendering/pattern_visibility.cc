// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/rendering/pattern_visibility.h"

#include <algorithm>
#include <vector>

#include "kestrel/simulation/scene/board_paint.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

// Returns points that cover the ink evenly.
std::vector<Vector2d> InkPoints(const TargetPrint& print) {
  const Drawing ink = InkOf(print);
  const double extent = HalfExtent(print);
  constexpr int kSteps = 60;
  const double step = 2 * extent / kSteps;
  std::vector<Vector2d> points;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const int column = i % kSteps;
    const int row = i / kSteps;
    const Vector2d cell(column + 0.5, row + 0.5);
    const Vector2d point = step * cell - Vector2d::Constant(extent);
    if (ink.NearestEdge(point).distance < 0) points.push_back(point);
  }
  return points;
}

}  // namespace

double VisibleFraction(const TargetPrint& print, const RigidTransform& camera_from_target,
                       const Lens& lens) {
  const std::vector<Vector2d> points = InkPoints(print);
  const auto seen = std::count_if(points.begin(), points.end(), [&](const Vector2d& point) {
    return lens.Sees(camera_from_target * Eigen::Vector3d(point.x(), point.y(), 0));
  });
  return static_cast<double>(seen) / static_cast<double>(points.size());
}

}  // namespace kestrel
