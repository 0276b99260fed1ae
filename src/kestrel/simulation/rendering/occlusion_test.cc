// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/rendering/occlusion.h"

#include <gtest/gtest.h>

#include "kestrel/simulation/scene/paint.h"
#include "kestrel/simulation/scene/solids.h"

namespace kestrel {
namespace {

const Eigen::Vector3d kEye(0, 0, 5);

// A horizontal square of 0.4 m above the origin.
World WithPlate(double height_m) {
  World world;
  AddPlate(0, {0, 0, height_m}, 0.2, 0.2, 0, PlainPaint(Gray(0.5), 1), &world);
  return world;
}

TEST(IsHidden, PlateHidesPointsBelow) {
  const World world = WithPlate(1);
  EXPECT_TRUE(IsHidden(world, 0, kEye, {0, 0, 0}));
  EXPECT_TRUE(IsHidden(world, 0, kEye, {0.24, 0, 0})) << "seen obliquely, past its edge";
  EXPECT_FALSE(IsHidden(world, 0, kEye, {0.26, 0, 0}));
  EXPECT_FALSE(IsHidden(world, 0, kEye, {0, 0, 2})) << "before the plate";
  EXPECT_FALSE(IsHidden(world, 0, {0, 0, 0.5}, {0, 0, 2})) << "its back is not seen";
}

TEST(IsHidden, PointOnSurfaceIsNotHiddenByIt) {
  EXPECT_FALSE(IsHidden(WithPlate(1), 0, kEye, {0, 0, 1}));
}

TEST(IsHidden, RoundMaskedAndInvisibleSurfacesHideLess) {
  World world = WithPlate(1);
  Surface& plate = world.surfaces.front();
  const Eigen::Vector3d corner(0.23, 0.23, 0);
  EXPECT_TRUE(IsHidden(world, 0, kEye, corner));
  plate.round = true;
  EXPECT_FALSE(IsHidden(world, 0, kEye, corner));
  EXPECT_TRUE(IsHidden(world, 0, kEye, {0, 0, 0}));
  plate.mask = std::make_shared<Texture>(cv::Mat(8, 8, CV_8U, cv::Scalar(0)), 1);
  EXPECT_FALSE(IsHidden(world, 0, kEye, {0, 0, 0})) << "all hole";
  plate.mask = nullptr;
  plate.visible = false;
  EXPECT_FALSE(IsHidden(world, 0, kEye, {0, 0, 0}));
}

}  // namespace
}  // namespace kestrel
