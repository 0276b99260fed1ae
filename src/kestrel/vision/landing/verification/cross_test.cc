// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/verification/cross.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
const LandingPattern kPattern{};
// In inner radii.
const double kHalfWidth = 0.5 * kPattern.arm_width_m / kPattern.inner_radius_m();
const double kLength = kPattern.arm_half_length_m / kPattern.inner_radius_m();

// Draws the rectified inside of a ring with 'print' in it, turned by 'angle', the centre displaced.
RingInside Draw(int size, const Print& print, double angle, double dx = 0) {
  RingInside inside{SmallMask(size), SmallMask(size), 1};
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const double u = inside.Coordinate(x), v = inside.Coordinate(y);
      if (std::hypot(u, v) > 0.9) continue;
      inside.disc.Set(x, y);
      const double c = std::cos(angle), s = std::sin(angle);
      if (print(c * (u - dx) + s * v, c * v - s * (u - dx))) inside.dark.Set(x, y);
    }
  }
  return inside;
}

Print Spokes(int count) {
  return [count](double x, double y) { return IsSpoke(x, y, count, kHalfWidth, kLength); };
}

struct Method {
  const char* name;
  int size;
  double tolerance;  // rad
  std::optional<Cross> (*find)(const RingInside&);
};

const std::vector<Method> kMethods = {{"quadrants", 24, 3 * kDegree, FindCrossByQuadrants},
                                      {"thinning", 40, 2 * kDegree, FindCrossByThinning},
                                      {"lines", 64, 1.5 * kDegree, [](const RingInside& inside) {
                                         CrossLinesWorkspace workspace;
                                         return FindCrossByLines(inside, kPattern, &workspace);
                                       }}};

class EveryMethod : public ::testing::TestWithParam<Method> {
 protected:
  std::optional<Cross> Find(const Print& print, double angle, double dx = 0) const {
    return GetParam().find(Draw(GetParam().size, print, angle, dx));
  }
};

TEST_P(EveryMethod, FindsTheArmsOfACross) {
  for (int degrees = 0; degrees < 90; degrees += 5) {
    const auto cross = Find(Spokes(4), degrees * kDegree);
    ASSERT_TRUE(cross) << degrees;
    EXPECT_NEAR(std::remainder(cross->arm_angle - degrees * kDegree, std::numbers::pi / 2), 0,
                GetParam().tolerance)
        << degrees;
  }
}

TEST_P(EveryMethod, RefusesAnotherNumberOfSpokes) {
  for (const int spokes : {1, 2, 3, 5}) {
    for (int degrees = 0; degrees < 90; degrees += 7) {
      EXPECT_FALSE(Find(Spokes(spokes), degrees * kDegree)) << spokes << " at " << degrees;
    }
  }
}

TEST_P(EveryMethod, RefusesABar) {
  const Print bar = [](double, double y) { return std::abs(y) < kHalfWidth; };
  for (int degrees = 0; degrees < 90; degrees += 7) EXPECT_FALSE(Find(bar, degrees * kDegree));
}

TEST_P(EveryMethod, RefusesACrossFarFromTheMiddle) {
  const Print cross = [](double x, double y) {
    return std::min(std::abs(x), std::abs(y)) < kHalfWidth;
  };
  EXPECT_TRUE(Find(cross, 0));
  for (int degrees = 0; degrees < 90; degrees += 15) {
    EXPECT_FALSE(Find(cross, degrees * kDegree, 0.6)) << degrees;
  }
}

TEST_P(EveryMethod, RefusesWhatHasNoLines) {
  EXPECT_FALSE(Find([](double, double) { return false; }, 0));
  EXPECT_FALSE(Find([](double, double) { return true; }, 0));
  EXPECT_FALSE(Find([](double x, double y) { return std::hypot(x, y) < 0.5; }, 0));
}

INSTANTIATE_TEST_SUITE_P(Cross, EveryMethod, ::testing::ValuesIn(kMethods),
                         [](const auto& info) { return info.param.name; });

TEST(FindCrossByQuadrants, CountsToFour) {
  for (const int spokes : {6, 8}) {
    EXPECT_FALSE(FindCrossByQuadrants(Draw(64, Spokes(spokes), 0.2))) << spokes;
  }
}

TEST(FindCrossByQuadrants, ClosesGaps) {
  // An arm has a gap of one pixel. Without closing it, two quadrants would be one.
  RingInside inside = Draw(24, Spokes(4), 0);
  for (int y = 0; y < 24; ++y) inside.dark.Clear(16, y);
  EXPECT_TRUE(FindCrossByQuadrants(inside));
  for (int x = 15; x < 19; ++x) {
    for (int y = 0; y < 24; ++y) inside.dark.Clear(x, y);
  }
  EXPECT_FALSE(FindCrossByQuadrants(inside));
}

TEST(FindCrossByThinning, AsksForTheHalfArmsThatAreInView) {
  RingInside inside = Draw(40, Spokes(4), 20 * kDegree);
  for (int y = 0; y < 40; ++y) {
    for (int x = 20; x < 40; ++x) {
      inside.disc.Clear(x, y);
      inside.dark.Clear(x, y);
    }
  }
  const auto cross = FindCrossByThinning(inside);
  ASSERT_TRUE(cross);
  EXPECT_NEAR(std::remainder(cross->arm_angle - 20 * kDegree, std::numbers::pi / 2), 0,
              4 * kDegree);
}

TEST(RectifyInside, ShowsTheCrossOfAnImage) {
  const CameraModel camera = TestPrintCamera();
  const RigidTransform pose = PrintPose({0.2, -0.1, 2.2}, 0.5, 0.7, 0);
  const cv::Mat image = DrawPrint(camera, kPattern, SpokedPrint(kPattern, 4), pose);
  const PatternView view(camera, pose, 0.6, {});
  const auto inside = RectifyInside(image, view, kPattern, 40, 6);
  ASSERT_TRUE(inside);
  EXPECT_EQ(inside->seen, 1);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      const double u = inside->Coordinate(x), v = inside->Coordinate(y);
      EXPECT_EQ(inside->disc.at(x, y), std::hypot(u, v) < 0.9);
      if (std::hypot(u, v) > 0.85) continue;
      // Near the boundary of black and white, the threshold decides.
      int dark = 0;
      for (const double dv : {-0.06, 0.0, 0.06}) {
        for (const double du : {-0.06, 0.0, 0.06}) {
          dark += IsSpoke(u + du, v + dv, 4, kHalfWidth, kLength);
        }
      }
      if (dark == 0 || dark == 9) {
        EXPECT_EQ(inside->dark.at(x, y), dark == 9) << x << ", " << y;
      }
    }
  }
}

TEST(RectifyInside, SaysNothingWithoutContrastOrOutOfView) {
  const CameraModel camera = TestPrintCamera();
  const cv::Mat flat(240, 320, CV_8UC1, cv::Scalar(90));
  const RigidTransform pose = PrintPose({0, 0, 2}, 0, 0, 0);
  EXPECT_FALSE(RectifyInside(flat, PatternView(camera, pose, 0.6, {}), kPattern, 40, 6));
  const RigidTransform aside = PrintPose({1.9, 0, 2}, 0, 0, 0);
  const cv::Mat image = DrawPrint(camera, kPattern, SpokedPrint(kPattern, 4), aside);
  EXPECT_FALSE(RectifyInside(image, PatternView(camera, aside, 0.6, {}), kPattern, 40, 6));
}

class CrossProfileTest : public ::testing::Test {
 protected:
  // Finds the direction in a print seen from straight above, in the view of its ring. The image
  // shows the columns from 'first_column' on.
  std::optional<Cross> Find(const Print& print, double angle, int first_column = 0,
                            int shadow_column = 0) const {
    const RigidTransform pose = PrintPose({0, 0, 1.2}, 0, 0, 0);
    RigidTransform turned = pose;
    turned.rotation *= Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
    cv::Mat image = DrawPrint(camera_, kPattern, print, turned);
    if (shadow_column > 0) image.colRange(0, shadow_column) *= 0.4;
    const PatternView view(camera_, pose, 0.6, {{first_column, 0}, 0});
    return FindCrossByProfile(image.colRange(first_column, image.cols), view, kPattern, 10);
  }
  static double ErrorModuloRightAngle(double found, double angle) {
    return std::abs(std::remainder(found - angle, std::numbers::pi / 2));
  }

  const CameraModel camera_ = TestPrintCamera();
  const Print pattern_ = SpokedPrint(kPattern, 4);
};

TEST_F(CrossProfileTest, FindsTheArms) {
  for (double angle = 0; angle < 1.57; angle += 0.2) {
    const auto cross = Find(pattern_, angle);
    ASSERT_TRUE(cross) << angle;
    EXPECT_LT(ErrorModuloRightAngle(cross->arm_angle, angle), 2 * kDegree) << angle;
  }
}

TEST_F(CrossProfileTest, FindsThemInHalfOfThePrintAndAcrossAShadow) {
  for (double angle = 0; angle < 1.57; angle += 0.2) {
    const auto cut_off = Find(pattern_, angle, 165);
    ASSERT_TRUE(cut_off) << angle;
    EXPECT_LT(ErrorModuloRightAngle(cut_off->arm_angle, angle), 4 * kDegree) << angle;
    const auto shadowed = Find(pattern_, angle, 0, 150);
    ASSERT_TRUE(shadowed) << angle;
    EXPECT_LT(ErrorModuloRightAngle(shadowed->arm_angle, angle), 4 * kDegree) << angle;
  }
}

TEST_F(CrossProfileTest, AnEmptyRingHasNone) {
  EXPECT_FALSE(Find([](double x, double y) { return IsRing(kPattern, x, y); }, 0));
}

}  // namespace
}  // namespace kestrel
