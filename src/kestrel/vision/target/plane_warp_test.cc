// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/target/plane_warp.h"

#include <cmath>
#include <vector>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include "kestrel/core/camera/test_cameras.h"
#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

constexpr double kRadius = 0.5;  // m

std::vector<Eigen::Vector2d> PointsOnPrint() {
  std::vector<Eigen::Vector2d> points;
  for (double x = -kRadius; x <= kRadius; x += 0.05) {
    for (double y = -kRadius; y <= kRadius; y += 0.05) {
      if (std::hypot(x, y) <= kRadius) points.emplace_back(x, y);
    }
  }
  return points;
}

PlaneWarp::Coefficients RandomDisplacement(Random* random) {
  PlaneWarp::Coefficients displacement;
  for (double& value : displacement.reshaped()) value = random->Uniform(-4, 4);
  return displacement;
}

TEST(PlaneWarp, EqualsLensWithoutDisplacement) {
  const CameraModel camera(EurocCamera());
  const RigidTransform pose = PrintPose({0.2, -0.1, 1.5}, 0.4, 1, 0.3);
  const PlaneWarp warp(camera, pose, kRadius);
  for (const Eigen::Vector2d& point : PointsOnPrint()) {
    Eigen::Vector2d expected, pixel;
    camera.Project(pose * Eigen::Vector3d(point.x(), point.y(), 0), &expected);
    ASSERT_TRUE(warp.Project(point, &pixel));
    EXPECT_LT((pixel - expected).norm(), 1e-9);
  }
}

TEST(PlaneWarp, DerivativeMatchesProjection) {
  Random random(1);
  for (const CameraIntrinsics& intrinsics : {PaperCamera(), EurocCamera()}) {
    const CameraModel camera(intrinsics);
    PlaneWarp warp(camera, PrintPose({0.2, -0.1, 1.5}, 0.4, 1, 0.3), kRadius);
    warp.Displace(RandomDisplacement(&random));
    for (const Eigen::Vector2d& point : PointsOnPrint()) {
      Eigen::Vector2d pixel;
      Eigen::Matrix2d derivative;
      ASSERT_TRUE(warp.Project(point, &pixel, &derivative));
      constexpr double kStep = 1e-5;
      for (int k = 0; k < 2; ++k) {
        Eigen::Vector2d before, after;
        warp.Project(point - kStep * Eigen::Vector2d::Unit(k), &before);
        warp.Project(point + kStep * Eigen::Vector2d::Unit(k), &after);
        EXPECT_LT((derivative.col(k) - (after - before) / (2 * kStep)).norm(),
                  1e-4 * derivative.norm());
      }
    }
  }
}

TEST(PlaneWarp, DisplacementsAddUp) {
  Random random(2);
  const CameraModel camera = TestPrintCamera();
  const RigidTransform pose = PrintPose({0, 0, 2}, 0.2, 1, 0);
  const PlaneWarp::Coefficients a = RandomDisplacement(&random), b = RandomDisplacement(&random);
  const PlaneWarp still(camera, pose, kRadius);
  PlaneWarp warp = still;
  warp.Displace(a);
  warp.Displace(b);
  for (const Eigen::Vector2d& point : PointsOnPrint()) {
    Eigen::Vector2d from, to;
    still.Project(point, &from);
    warp.Project(point, &to);
    EXPECT_LT((to - from - (a + b) * warp.TermsAt(point)).norm(), 1e-9);
  }
  warp.Displace(-a - b);
  Eigen::Vector2d from, to;
  still.Project({0.3, 0.2}, &from);
  warp.Project({0.3, 0.2}, &to);
  EXPECT_LT((to - from).norm(), 1e-9);
}

TEST(PlaneWarp, TermsRiseByDegree) {
  const CameraModel camera = TestPrintCamera();
  const PlaneWarp warp(camera, PrintPose({0, 0, 2}, 0, 0, 0), kRadius);
  const Eigen::Vector2d point(0.3, -0.2);
  const PlaneWarp::Terms once = warp.TermsAt(point), twice = warp.TermsAt(2 * point);
  for (int i = 0; i < PlaneWarp::kTerms; ++i) {
    EXPECT_NEAR(twice(i), std::pow(2, PlaneWarp::DegreeOf(i)) * once(i), 1e-9) << i;
  }
  EXPECT_EQ(PlaneWarp::DegreeOf(PlaneWarp::kTerms - 1), PlaneWarp::kDegree);
}

// Fits the warp to the displacement between the image of the flat print through 'camera' and the
// image given by 'shown'. Returns the root mean square residual, px.
template <class Shown>
double LeftByFit(const CameraModel& camera, const RigidTransform& pose, const Shown& shown) {
  const PlaneWarp warp(camera, pose, kRadius);
  const std::vector<Eigen::Vector2d> points = PointsOnPrint();
  Eigen::MatrixXd terms(points.size(), static_cast<int>(PlaneWarp::kTerms));
  Eigen::MatrixXd way(points.size(), 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    Eigen::Vector2d flat;
    warp.Project(points[i], &flat);
    terms.row(row) = warp.TermsAt(points[i]).transpose();
    way.row(row) = (shown(points[i]) - flat).transpose();
  }
  const Eigen::MatrixXd left = way - terms * terms.colPivHouseholderQr().solve(way);
  return left.norm() / std::sqrt(static_cast<double>(points.size()));
}

// Boards that are not flat and calibrations that are wrong, for a ring of 220 px. The warp explains
// them to a fraction of a pixel where they move the print by several pixels.
TEST(PlaneWarp, ExplainsUnevenBoardsAndWrongLenses) {
  const CameraModel camera = TestPrintCamera();
  const RigidTransform pose = PrintPose({0.1, -0.05, 1}, 0.35, 0.8, 0.3);
  const auto see = [](const CameraModel& lens, const RigidTransform& at, double x, double y,
                      double z) {
    Eigen::Vector2d pixel;
    lens.Project(at * Eigen::Vector3d(x, y, z), &pixel);
    return pixel;
  };
  EXPECT_LT(LeftByFit(camera, pose,
                      [&](const Eigen::Vector2d& p) {
                        const double height =
                            0.045 * (1 - p.squaredNorm() / (0.75 * 0.75));  // bulge
                        return see(camera, pose, p.x(), p.y(), height);
                      }),
            0.3);
  for (const double zoom : {0.7, 1.3}) {
    CameraIntrinsics intrinsics = camera.intrinsics();
    intrinsics.fx_px *= zoom;
    intrinsics.fy_px *= zoom;
    const CameraModel zoomed(intrinsics);
    RigidTransform as_large = pose;
    as_large.translation.z() *= zoom;
    EXPECT_LT(
        LeftByFit(zoomed, as_large,
                  [&](const Eigen::Vector2d& p) { return see(camera, pose, p.x(), p.y(), 0); }),
        0.5)
        << zoom;
  }
  CameraIntrinsics barrel = camera.intrinsics();
  barrel.distortion_model = DistortionModel::kRadialTangential;
  barrel.distortion = {-0.28, 0.07, 0, 0};
  const CameraModel distorted(barrel);
  EXPECT_LT(
      LeftByFit(camera, pose,
                [&](const Eigen::Vector2d& p) { return see(distorted, pose, p.x(), p.y(), 0); }),
      0.5);
}

TEST(PlaneWarp, ProjectsNothingBehindCamera) {
  const CameraModel camera = TestPrintCamera();
  Eigen::Vector2d pixel;
  EXPECT_FALSE(PlaneWarp(camera, PrintPose({0, 0, -2}, 0, 0, 0), kRadius).Project({0, 0}, &pixel));
}

}  // namespace
}  // namespace kestrel
