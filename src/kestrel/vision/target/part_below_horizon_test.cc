// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/target/part_below_horizon.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr double kMargin = Radians(5);

// A camera of 640x480 px that sees 76 degrees to the left and right and 57 up and down.
CameraModel Camera() {
  return CameraModel(
      {640, 480, 240, 240, 319.5, 239.5, DistortionModel::kEquidistant, {0, 0, 0, 0}});
}

// Up, in a camera that is tilted from straight down towards the top of the image, and then rolled
// about its axis.
Vector3d Up(double tilt_deg, double roll_deg = 0) {
  return RotationBy({0, 0, Radians(roll_deg)}) * RotationBy({-Radians(tilt_deg), 0, 0}) *
         Vector3d(0, 0, -1);
}

TEST(PartBelowHorizonTest, CameraThatLooksDownSeesGroundOnly) {
  for (const double tilt_deg : {0.0, 20.0, 45.0}) {
    EXPECT_FALSE(PartBelowHorizon(Camera(), Up(tilt_deg), kMargin)) << tilt_deg;
  }
}

TEST(PartBelowHorizonTest, CameraThatLooksAheadSeesGroundBelowTheMiddle) {
  const auto part = PartBelowHorizon(Camera(), Up(90), kMargin);
  ASSERT_TRUE(part);
  EXPECT_EQ(part->x, 0);
  EXPECT_EQ(part->width, 640);
  EXPECT_EQ(part->y + part->height, 480);
  // The horizon is in row 240, 5 degrees above it in row 219.
  EXPECT_LE(part->y, 219);
  EXPECT_GE(part->y, 219 - 2 * 32);
}

TEST(PartBelowHorizonTest, RolledCameraKeepsAllGround) {
  const CameraModel camera = Camera();
  const Vector3d up = Up(90, 8);
  const auto part = PartBelowHorizon(camera, up, kMargin);
  ASSERT_TRUE(part);
  for (int y = 0; y < 480; y += 7) {
    for (int x = 0; x < 640; x += 7) {
      Vector3d ray;
      ASSERT_EQ(camera.Unproject({x, y}, &ray), ProjectionStatus::kOk);
      const bool is_ground = ray.dot(up) < 0;
      EXPECT_TRUE(!is_ground || part->contains({x, y})) << x << " " << y;
    }
  }
}

TEST(PartBelowHorizonTest, NoGroundInViewIsAWrongAttitude) {
  EXPECT_FALSE(PartBelowHorizon(Camera(), Up(180), kMargin));
}

}  // namespace
}  // namespace kestrel
