// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/assumed_lens.h"

#include <gtest/gtest.h>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

TEST(AssumedLens, SpansFieldOfViewFromEdgeToEdge) {
  for (const double fov_deg : {kMinFov_deg, 60.0, 100.0, 101.0, 180.0, kMaxFov_deg}) {
    const CameraModel camera(AssumedLens(640, 480, fov_deg));
    Eigen::Vector3d left, right;
    ASSERT_NE(camera.Unproject({-0.5, 239.5}, &left), ProjectionStatus::kOutsideModel) << fov_deg;
    ASSERT_NE(camera.Unproject({639.5, 239.5}, &right), ProjectionStatus::kOutsideModel) << fov_deg;
    const double to_left = std::atan2(-left.x(), left.z());
    const double to_right = std::atan2(right.x(), right.z());
    EXPECT_NEAR(Degrees(to_left + to_right), fov_deg, 1e-3);
  }
}

}  // namespace
}  // namespace kestrel
