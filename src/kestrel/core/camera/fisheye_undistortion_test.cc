// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/fisheye_undistortion.h"

#include <numbers>

#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/test_cameras.h"

namespace kestrel {
namespace {

Eigen::Vector2d PixelAt(const CameraModel& camera, double angle, double azimuth) {
  Eigen::Vector2d pixel;
  camera.Project(RayAt(angle, azimuth), &pixel);
  return pixel;
}

Eigen::Vector2d PlanePoint(double angle, double azimuth) {
  return std::tan(angle) * Eigen::Vector2d(std::cos(azimuth), std::sin(azimuth));
}

TEST(UndistortIterative, ConvergesNearAxis) {
  const CameraModel camera(PaperCamera());
  for (double angle = 0; angle < 60 * kDegree; angle += kDegree) {
    const Eigen::Vector2d pixel = PixelAt(camera, angle, 2);
    EXPECT_LT((UndistortIterative(camera.intrinsics(), pixel) - PlanePoint(angle, 2)).norm(), 1e-5);
  }
}

TEST(FisheyeUndistortionTable, MatchesAlgorithmOneWithinGrid) {
  const CameraModel camera(PaperCamera());
  const FisheyeUndistortionTable table(camera.intrinsics());
  for (double angle = 0; angle < 75 * kDegree; angle += kDegree) {
    const Eigen::Vector2d pixel = PixelAt(camera, angle, 4);
    const Eigen::Vector2d expected = UndistortIterative(camera.intrinsics(), pixel);
    const Eigen::Vector2d found = table.Undistort(pixel.cast<float>()).cast<double>();
    EXPECT_LT((found - expected).norm(), 2e-3 * expected.norm() + 1e-6) << angle / kDegree;
  }
}

TEST(FisheyeUndistortionTable, UsesLastEntryBeyondCorner) {
  const FisheyeUndistortionTable table(PaperCamera());
  const Eigen::Vector2f corner = table.Undistort({0, 0});
  const Eigen::Vector2f beyond = table.Undistort({376 - 3 * 376, 240 - 3 * 240});
  EXPECT_LT((beyond - 3 * corner).norm(), 1e-5f * beyond.norm());
}

TEST(FisheyeUndistortionTable, RefusesOtherLensModels) {
  EXPECT_THROW(FisheyeUndistortionTable{EurocCamera()}, InputError);
  CameraIntrinsics zero = PaperCamera();
  zero.fx_px = 0;
  EXPECT_THROW(FisheyeUndistortionTable{zero}, InputError);
}

}  // namespace
}  // namespace kestrel
