// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/geometry/cone.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace kestrel {
namespace {

// Returns a rotation whose rows are an orthonormal base with 'axis' as the third.
Eigen::Matrix3d BaseAround(const Eigen::Vector3d& axis) {
  Eigen::Matrix3d base;
  base.row(2) = axis.normalized();
  base.row(0) = axis.unitOrthogonal();
  base.row(1) = base.row(2).cross(base.row(0));
  return base;
}

// The exponents of x and y in three terms of a conic.
using Terms = std::array<std::array<int, 2>, 3>;
constexpr Terms kQuadratic{{{2, 0}, {1, 1}, {0, 2}}};
constexpr Terms kLinear{{{1, 0}, {0, 1}, {0, 0}}};

// Sums of x^i y^j over points of a plane, i + j <= 4.
struct PlaneMoments {
  std::array<std::array<double, 5>, 5> sum{};

  void Add(double x, double y) {
    double x_power = 1;
    for (int i = 0; i <= 4; ++i, x_power *= x) {
      double power = x_power;
      for (int j = 0; i + j <= 4; ++j, power *= y) sum[i][j] += power;
    }
  }
  void Scale(double scale) {
    double x_power = 1;
    for (int i = 0; i <= 4; ++i, x_power *= scale) {
      double power = x_power;
      for (int j = 0; i + j <= 4; ++j, power *= scale) sum[i][j] *= power;
    }
  }
  // Returns the block of the design matrix's scatter for these terms.
  Eigen::Matrix3d Scatter(const Terms& rows, const Terms& columns) const {
    Eigen::Matrix3d scatter;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        scatter(r, c) = sum[rows[r][0] + columns[c][0]][rows[r][1] + columns[c][1]];
      }
    }
    return scatter;
  }
};

// Returns the quadratic coefficients (a, b, c) of the ellipse, 4 a c - b^2 = 1, that minimize v^T m
// v. 'm' is symmetric without negative eigenvalues. With m = l l^T, m v = lambda c v becomes a
// symmetric problem in w = l^T v, which has one positive eigenvalue, 1 / lambda.
std::optional<Eigen::Vector3d> LeastEllipse(Eigen::Matrix3d m) {
  m.diagonal().array() += 1e-14 * m.trace();  // for points exactly on an ellipse, m is singular
  const Eigen::LLT<Eigen::Matrix3d> factor(m);
  if (factor.info() != Eigen::Success) return std::nullopt;
  Eigen::Matrix3d constraint;
  constraint << 0, 0, 2, 0, -1, 0, 2, 0, 0;
  const Eigen::Matrix3d half = factor.matrixL().solve(constraint);
  const Eigen::Matrix3d whole = factor.matrixL().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(whole);
  if (!(solver.eigenvalues()(2) > 0)) return std::nullopt;
  return factor.matrixU().solve(solver.eigenvectors().col(2));
}

}  // namespace

Eigen::Vector2d Cone::HalfAngles() const {
  const Eigen::Vector3d l =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
  const double axis = std::max(0.0, -l(0));
  return {std::atan2(std::sqrt(axis), std::sqrt(std::max(0.0, l(1)))),
          std::atan2(std::sqrt(axis), std::sqrt(std::max(0.0, l(2))))};
}

std::optional<Cone> FitCone(std::span<const Eigen::Vector3d> rays) {
  if (rays.size() < 6) return std::nullopt;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& ray : rays) mean += ray;
  if (mean.norm() < 1e-6 * static_cast<double>(rays.size())) return std::nullopt;
  const Eigen::Matrix3d tangent_from_camera = BaseAround(mean);

  PlaneMoments moments;
  for (const Eigen::Vector3d& ray : rays) {
    const Eigen::Vector3d p = tangent_from_camera * ray;
    if (p.z() < 0.05) return std::nullopt;
    moments.Add(p.x() / p.z(), p.y() / p.z());
  }
  // Scales the plane so that the points are of the order of one.
  const double spread = moments.sum[2][0] + moments.sum[0][2];
  const double scale = std::sqrt(static_cast<double>(rays.size()) / std::max(spread, 1e-18));
  moments.Scale(scale);
  const Eigen::Matrix3d s1 = moments.Scatter(kQuadratic, kQuadratic);
  const Eigen::Matrix3d s2 = moments.Scatter(kQuadratic, kLinear);
  const Eigen::Matrix3d s3 = moments.Scatter(kLinear, kLinear);
  if (std::abs(s3.determinant()) < 1e-12) return std::nullopt;
  const Eigen::Matrix3d t = -s3.inverse() * s2.transpose();
  const Eigen::Matrix3d m = s1 + s2 * t;
  const std::optional<Eigen::Vector3d> quadratic = LeastEllipse(m);
  if (!quadratic) return std::nullopt;
  const Eigen::Vector3d& a = *quadratic;
  const Eigen::Vector3d b = t * a;
  Eigen::Matrix3d conic;
  conic << a(0) * scale * scale, 0.5 * a(1) * scale * scale, 0.5 * b(0) * scale,
      0.5 * a(1) * scale * scale, a(2) * scale * scale, 0.5 * b(1) * scale,  //
      0.5 * b(0) * scale, 0.5 * b(1) * scale, b(2);
  if (a(0) + a(2) < 0) conic = -conic;
  if (!(conic.determinant() < 0)) return std::nullopt;  // an empty or degenerate conic
  Cone cone;
  cone.matrix = tangent_from_camera.transpose() * conic * tangent_from_camera;
  cone.matrix /= cone.matrix.norm();
  return cone;
}

std::array<CirclePose, 2> CirclePosesFromCone(const Cone& cone, double radius,
                                              const Eigen::Vector3d& toward) {
  // In the eigenframe the cone is l1 x^2 + l2 y^2 + l3 z^2 = 0 with l1 >= l2 > 0 > l3. The planes
  // that cut it in circles are parallel to the y axis.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(cone.matrix);
  const double l3 = solver.eigenvalues()(0);
  const double l2 = solver.eigenvalues()(1);
  const double l1 = solver.eigenvalues()(2);
  const Eigen::Vector3d e1 = solver.eigenvectors().col(2);
  Eigen::Vector3d e3 = solver.eigenvectors().col(0);
  if (e3.dot(toward) < 0) e3 = -e3;
  const double sine = std::sqrt(std::max(0.0, (l1 - l2) / (l1 - l3)));
  const double cosine = std::sqrt(std::max(0.0, (l2 - l3) / (l1 - l3)));
  const double depth = radius / std::sqrt(std::max(1e-300, -l1 * l3));
  std::array<CirclePose, 2> poses;
  for (int i = 0; i < 2; ++i) {
    const double sign = i == 0 ? 1.0 : -1.0;
    poses[i].normal = -sign * sine * e1 - cosine * e3;
    poses[i].center = depth * (sign * l3 * sine * e1 + l1 * cosine * e3);
  }
  return poses;
}

}  // namespace kestrel
