// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/square_pose.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "kestrel/vision/search/plane_figure.h"

namespace kestrel {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr std::array<std::array<double, 2>, 4> kCorners{
    {{-0.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}, {-0.5, -0.5}}};

// Axes of a frame whose third looks along 'sight'.
Eigen::Matrix3d AxesAlong(const Eigen::Vector3d& sight) {
  Eigen::Matrix3d axes;
  axes.col(2) = sight;
  axes.col(0) = sight.unitOrthogonal();
  axes.col(1) = sight.cross(axes.col(0));
  return axes;
}

// A pose, and half of the squared angles between the rays and the corners that it predicts.
struct SquareFit {
  RigidTransform pose;
  double cost = INFINITY;
};

// The step of Gauss-Newton from a pose, on the angles across each ray; the cost is of the pose
// itself.
Vector6 StepOf(const SquareCorners& corners, SquareFit* fit) {
  Eigen::Matrix<double, 8, 6> derivative;
  Eigen::Matrix<double, 8, 1> residual;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Matrix3d axes = AxesAlong(corners[i]);
    const Eigen::Vector3d arm =
        fit->pose.rotation * Eigen::Vector3d(kCorners[i][0], kCorners[i][1], 0);
    const Eigen::Vector3d point = fit->pose.translation + arm;
    const double depth = corners[i].dot(point);
    for (int k = 0; k < 2; ++k) {
      const double across = axes.col(k).dot(point) / depth;
      const Eigen::Vector3d by_point = (axes.col(k) - across * corners[i]) / depth;
      residual[2 * i + k] = -across;
      derivative.row(2 * i + k) << by_point.transpose(), arm.cross(by_point).transpose();
    }
  }
  fit->cost = 0.5 * residual.squaredNorm();
  return (derivative.transpose() * derivative).ldlt().solve(derivative.transpose() * residual);
}

SquareFit Fitted(const SquareCorners& corners, const RigidTransform& start) {
  constexpr int kSteps = 5;
  constexpr double kMostSquareTurn = 0.5;  // in a step, rad
  SquareFit fit{start};
  for (int i = 0; i < kSteps; ++i) {
    Vector6 step = StepOf(corners, &fit);
    if (!step.allFinite()) return {};
    step *= kMostSquareTurn / std::max(kMostSquareTurn, step.tail<3>().norm());
    fit.pose = Moved(fit.pose, step.head<3>(), step.tail<3>());
  }
  StepOf(corners, &fit);
  const bool is_in_front = fit.pose.translation.dot(corners[0]) > 0;
  return is_in_front && std::isfinite(fit.cost) ? fit : SquareFit{};
}

}  // namespace

std::optional<Eigen::Matrix3d> HomographyOfSquare(const SquareCorners& corners) {
  Eigen::Vector3d sight = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : corners) sight += corner;
  const Eigen::Matrix3d axes = AxesAlong(sight.normalized());
  Eigen::Matrix<double, 8, 8> equations;
  Eigen::Matrix<double, 8, 1> seen;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d corner = axes.transpose() * corners[i];
    if (corner.z() <= 0) return std::nullopt;
    const Eigen::Vector2d p = corner.hnormalized();
    const auto [x, y] = kCorners[i];
    equations.row(2 * i) << x, y, 1, 0, 0, 0, -p.x() * x, -p.x() * y;
    equations.row(2 * i + 1) << 0, 0, 0, x, y, 1, -p.y() * x, -p.y() * y;
    seen.segment<2>(2 * i) = p;
  }
  const Eigen::Matrix<double, 8, 1> h = equations.partialPivLu().solve(seen);
  if (!h.allFinite()) return std::nullopt;
  Eigen::Matrix3d plane_from_square;
  plane_from_square << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1;
  return axes * plane_from_square;
}

std::optional<RigidTransform> PoseOfSquare(const SquareCorners& corners,
                                           const Eigen::Matrix3d& homography) {
  // The perspective of a small square is noise: the start is by the map near its middle alone.
  const Eigen::Vector3d middle = homography.col(2);
  const Eigen::Matrix3d axes = AxesAlong(middle.normalized());
  const Eigen::Matrix2d map =
      axes.leftCols<2>().transpose() * homography.leftCols<2>() / middle.norm();
  if (!(map.determinant() < 0)) return std::nullopt;  // y goes up in the square, down in the image
  SquareFit best;
  for (const double sign : {1.0, -1.0}) {
    const SquareFit fit =
        Fitted(corners, PoseOfAffineMap(axes, map, Eigen::Vector2d::Zero(), sign));
    if (fit.cost < best.cost) best = fit;
  }
  if (!std::isfinite(best.cost)) return std::nullopt;
  const Eigen::Vector3d face = best.pose.rotation * Eigen::Vector3d::UnitZ();
  if (face.dot(best.pose.translation) >= 0) return std::nullopt;
  return best.pose;
}

}  // namespace kestrel
