// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/verification/cross.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
const LandingPattern kPattern{};

class FindArmsTest : public ::testing::Test {
 protected:
  // Finds the direction in a print seen from straight above, in the view of its ring. The image
  // shows the columns from 'first_column' on.
  std::optional<ArmDirection> Find(const Print& print, double angle, int first_column = 0,
                                   int shadow_column = 0) const {
    const RigidTransform pose = PrintPose({0, 0, 1.2}, 0, 0, 0);
    RigidTransform turned = pose;
    turned.rotation *= Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
    cv::Mat image = DrawPrint(camera_, kPattern, print, turned);
    if (shadow_column > 0) image.colRange(0, shadow_column) *= 0.4;
    const PatternView view(camera_, pose, 0.6, {{first_column, 0}, 0});
    return FindArms(image.colRange(first_column, image.cols), view, kPattern);
  }
  static double ErrorModuloRightAngle(double found, double angle) {
    return std::abs(std::remainder(found - angle, std::numbers::pi / 2));
  }

  const CameraModel camera_ = TestPrintCamera();
  const Print pattern_ = SpokedPrint(kPattern, 4);
};

TEST_F(FindArmsTest, FindsArms) {
  for (double angle = 0; angle < 1.57; angle += 0.2) {
    const auto found = Find(pattern_, angle);
    ASSERT_TRUE(found) << angle;
    EXPECT_LT(ErrorModuloRightAngle(found->angle, angle), 2 * kDegree) << angle;
  }
}

TEST_F(FindArmsTest, FindsArmsInHalfOfPrintAndAcrossShadow) {
  for (double angle = 0; angle < 1.57; angle += 0.2) {
    const auto cut_off = Find(pattern_, angle, 165);
    ASSERT_TRUE(cut_off) << angle;
    EXPECT_LT(ErrorModuloRightAngle(cut_off->angle, angle), 4 * kDegree) << angle;
    const auto shadowed = Find(pattern_, angle, 0, 150);
    ASSERT_TRUE(shadowed) << angle;
    EXPECT_LT(ErrorModuloRightAngle(shadowed->angle, angle), 4 * kDegree) << angle;
  }
}

TEST_F(FindArmsTest, EmptyRingHasNoContrast) {
  const auto found = Find([](double x, double y) { return IsRing(kPattern, x, y); }, 0);
  EXPECT_LT(found ? found->contrast : 0, 10);
  EXPECT_GT(Find(pattern_, 0)->contrast, 100);
}

}  // namespace
}  // namespace kestrel
