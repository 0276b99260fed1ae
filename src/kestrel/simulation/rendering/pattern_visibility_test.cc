// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/rendering/pattern_visibility.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

// The camera looks straight down; the pattern's centre appears in the direction of 'ray'.
RigidTransform NadirPose(const Vector3d& ray, double altitude_m) {
  const Eigen::Quaterniond down(Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX()));
  return {down, ray * (altitude_m / ray.z())};
}

TEST(VisibleFractionTest, AccountsForImageBorder) {
  const CameraModel camera(PaperCamera());
  const Lens lens(camera);
  const TargetPrint pattern = PrintOf(LandingPattern());
  EXPECT_EQ(VisibleFraction(pattern, NadirPose({0, 0, 1}, 3), lens), 1);
  Vector3d ray;
  ASSERT_NE(camera.Unproject({376, 479.5}, &ray), ProjectionStatus::kOutsideModel);
  EXPECT_NEAR(VisibleFraction(pattern, NadirPose(ray, 3), lens), 0.5, 0.03);
  ASSERT_NE(camera.Unproject({376, 560}, &ray), ProjectionStatus::kOutsideModel);
  EXPECT_EQ(VisibleFraction(pattern, NadirPose(ray, 3), lens), 0);
}

TEST(VisibleFractionTest, AccountsForLensCircleAndAirframe) {
  const CameraModel camera(PaperCamera());
  LensOptions options;
  options.half_angle_deg = 30;
  const TargetPrint pattern = PrintOf(LandingPattern());
  const Vector3d rim(std::sin(std::numbers::pi / 6), 0, std::cos(std::numbers::pi / 6));
  const Lens narrow(camera, options);
  EXPECT_NEAR(VisibleFraction(pattern, NadirPose(rim, 6), narrow), 0.5, 0.04);

  options.airframe.Add(Drawing::Bar{{376 + 100, 240}, {1, 0}, 100, 200});
  const Lens covered(camera, options);
  EXPECT_NEAR(VisibleFraction(pattern, NadirPose({0, 0, 1}, 3), covered), 0.5, 0.01);
}

}  // namespace
}  // namespace kestrel
