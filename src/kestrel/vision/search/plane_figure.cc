// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/search/plane_figure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

namespace kestrel {

double FigureMoments::Compactness() const {
  const double determinant = covariance.determinant();
  if (!(determinant > 0)) return 0;
  return std::abs(area) / (4 * std::numbers::pi * std::sqrt(determinant));
}

FigureMoments MomentsOf(std::span<const Eigen::Vector2d> corners) {
  FigureMoments moments;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d& a = corners[i];
    const Eigen::Vector2d& b = corners[(i + 1) % corners.size()];
    const double cross = a.x() * b.y() - b.x() * a.y();
    const Eigen::Vector2d sum = a + b;
    moments.area += cross / 2;
    first += cross / 6 * sum;
    second += cross / 24 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose());
  }
  if (moments.area == 0) return moments;
  moments.centroid = first / moments.area;
  moments.covariance = second / moments.area - moments.centroid * moments.centroid.transpose();
  return moments;
}

RigidTransform PoseOfAffineMap(const Eigen::Matrix3d& axes, const Eigen::Matrix2d& map,
                               const Eigen::Vector2d& center, double sign) {
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(map);
  const double scale = svd.singularValues()(0);
  const Eigen::Matrix2d flat = map / scale;
  const double first = std::sqrt(std::max(0.0, 1 - flat.col(0).squaredNorm()));
  double second = std::sqrt(std::max(0.0, 1 - flat.col(1).squaredNorm()));
  if (flat.col(0).dot(flat.col(1)) > 0) second = -second;
  Eigen::Matrix3d rotation;
  rotation.col(0) << flat.col(0), sign * first;
  rotation.col(1) << flat.col(1), sign * second;
  rotation.col(0).normalize();
  rotation.col(1) -= rotation.col(0).dot(rotation.col(1)) * rotation.col(0);
  rotation.col(1).normalize();
  rotation.col(2) = rotation.col(0).cross(rotation.col(1));
  return {Eigen::Quaterniond(Eigen::Matrix3d(axes * rotation)),
          axes * center.homogeneous() / scale};
}

}  // namespace kestrel
