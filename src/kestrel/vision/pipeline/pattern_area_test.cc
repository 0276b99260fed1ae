// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/pattern_area.h"

#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

CameraModel Pinhole() {
  return CameraModel({.width_px = 200,
                      .height_px = 100,
                      .fx_px = 100,
                      .fy_px = 100,
                      .cx_px = 100,
                      .cy_px = 50,
                      .distortion_model = DistortionModel::kNone,
                      .distortion = {}});
}

const TargetShape kShape = {.diameter_m = 1, .board_size_m = 1.5, .outlines = {}};

// A detection of the pattern (1 m) straight ahead, facing the camera.
TargetDetection At(const Vector3d& center_in_camera) {
  TargetDetection detection{};
  detection.camera_from_target = {
      Eigen::Quaterniond(AngleAxisd(std::numbers::pi, Vector3d::UnitX())), center_in_camera};
  return detection;
}

TEST(PatternAreaTest, SurroundsRing) {
  EXPECT_EQ(PatternArea(At({0, 0, 2}), kShape, Pinhole()), cv::Rect(75, 25, 51, 51));
}

TEST(PatternAreaTest, EndsAtImageBorder) {
  EXPECT_EQ(PatternArea(At({2, 0, 2}), kShape, Pinhole()), cv::Rect(175, 25, 25, 51));
  EXPECT_TRUE(PatternArea(At({9, 0, 2}), kShape, Pinhole()).empty()) << "beside the image";
  EXPECT_TRUE(PatternArea(At({0, 0, -2}), kShape, Pinhole()).empty()) << "behind the camera";
}

}  // namespace
}  // namespace kestrel
