// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/object_view.h"

#include <numbers>

#include <gtest/gtest.h>

#include "kestrel/vision/objects/test_objects.h"

namespace kestrel {
namespace {

// A camera 4 m above the origin that looks straight down, and a red disc of a map.
class ObjectViewTest : public ::testing::Test {
 protected:
  bool Shows(const Eigen::Vector3d& position, bool saw_all = true) const {
    MappedObject object;
    object.state.head<3>() = position;
    object.covariance.topLeftCorner<3, 3>() = sigma_m_ * sigma_m_ * Eigen::Matrix3d::Identity();
    const RigidTransform world_from_camera{
        Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX())),
        {0, 0, height_m_}};
    return ObjectView(detector_, report_, world_from_camera, saw_all).Shows(object);
  }

  ObjectDetector detector_{ObjectCamera(), DefaultObjectModel()};
  ObjectReport report_;
  double sigma_m_ = 0.02;
  double height_m_ = 4;
};

TEST_F(ObjectViewTest, ExpectsObjectsWellInsideImage) {
  EXPECT_TRUE(Shows({0, 0, 0}));
  EXPECT_TRUE(Shows({1.5, 1, 0}));
  EXPECT_FALSE(Shows({2.5, 0, 0})) << "at the image's border";
  EXPECT_FALSE(Shows({10, 0, 0}));
  EXPECT_FALSE(Shows({0, 0, 5})) << "behind the camera";
}

TEST_F(ObjectViewTest, ExpectsOnlyWellKnownAndLargeObjects) {
  sigma_m_ = 1;
  EXPECT_FALSE(Shows({0, 0, 0}));
  sigma_m_ = 0.02;
  height_m_ = 14;
  EXPECT_FALSE(Shows({0, 0, 0})) << "7 px across";
}

TEST_F(ObjectViewTest, ExpectsNothingInUnsearchedFrame) {
  EXPECT_FALSE(Shows({0, 0, 0}, /*saw_all=*/false));
}

TEST_F(ObjectViewTest, ExpectsNothingNearOtherDetection) {
  ObjectDetection detection;
  detection.center_px = {325, 240};
  report_.detections.push_back(detection);
  EXPECT_FALSE(Shows({0, 0, 0})) << "another object may hide it";
  EXPECT_TRUE(Shows({1, 0, 0}));
}

}  // namespace
}  // namespace kestrel
