// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/gimbal_pointing.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr GimbalView kNarrow{.half_angle = Radians(20.0), .pad_size_m = 1.2, .sight_range_m = 30};

// Points from 'place', with the nose 'heading_deg' from x to y, 20 times a second.
class PointingTest : public testing::Test {
 protected:
  GimbalAngles Point(const Vector3d& place, const std::optional<Vector3d>& target,
                     double heading_deg = 0) {
    now_ += std::chrono::milliseconds(50);
    const Eigen::Quaterniond level(Eigen::AngleAxisd(Radians(heading_deg), Vector3d::UnitZ()));
    return pointing_.Update({now_, {level, place}, target});
  }
  static double Off(const GimbalAngles& angles, const Vector3d& ray) {
    const Vector3d axis = angles.rotation() * Vector3d::UnitX();
    return Degrees(std::acos(std::clamp(axis.dot(ray.normalized()), -1.0, 1.0)));
  }

  GimbalPointing pointing_{kNarrow};
  Time now_ = TimeFromNanoseconds(1'000'000'000);
};

TEST_F(PointingTest, LooksAtTarget) {
  for (const Vector3d& target : {Vector3d(10, 0, 0), Vector3d(-8, 12, 1), Vector3d(3, -20, 0)}) {
    const Vector3d place(1, 2, 10);
    EXPECT_LT(Off(Point(place, target, 70), target - place), 1e-6);
    EXPECT_EQ(pointing_.step(), PointingStep::kTarget);
  }
}

TEST_F(PointingTest, TiltedCameraLooksAtTargetAlongItsAxis) {
  GimbalView view = kNarrow;
  view.axis_pitch = Radians(30.0);
  const Vector3d place(0, 0, 10), target(10, 0, 0);
  const GimbalAngles level =
      GimbalPointing(view).Update({now_, {Eigen::Quaterniond::Identity(), place}, target});
  EXPECT_NEAR(Degrees(level.pitch), 45 - 30, 1e-6);
}

// A target that passes below must not turn the camera around.
TEST_F(PointingTest, HoldsYawWhileTargetPassesBelow) {
  std::vector<double> yaws;
  for (double x = -20; x < 20; x += 0.2) {
    const Vector3d place(x, 0.3, 10);
    const GimbalAngles angles = Point(place, Vector3d::Zero());
    if (std::abs(x) < 1.5) yaws.push_back(angles.yaw);
    EXPECT_LT(Off(angles, -place), 15) << x;
  }
  const auto [least, most] = std::minmax_element(yaws.begin(), yaws.end());
  EXPECT_LT(*most - *least, 1e-9);
}

TEST_F(PointingTest, StaysWithinRangeOfMotion) {
  pointing_.set_range({.highest = Radians(-20.0), .lowest = Radians(60.0), .side = Radians(90.0)});
  const GimbalAngles behind = Point({0, 0, 10}, Vector3d(-10, 1, 0));
  EXPECT_NEAR(Degrees(behind.yaw), 90, 1e-6);
  EXPECT_NEAR(Degrees(Point({0, 0, 10}, Vector3d(0.5, 0, 0)).pitch), 60, 1e-6);
}

TEST_F(PointingTest, LooksStraightDownForLastMetresAndAfterContact) {
  EXPECT_NE(pointing_.step(), PointingStep::kDown);
  for (double height = 6; height > 0.2; height -= 0.05) {
    const GimbalAngles angles = Point({0.1, 0.1, height}, Vector3d::Zero());
    if (height < 2.5) {
      EXPECT_NEAR(Degrees(angles.pitch), 90, 1e-6) << height;
    }
  }
  EXPECT_EQ(pointing_.step(), PointingStep::kDown);
  EXPECT_NEAR(Degrees(Point({0.1, 0.1, 0.3}, std::nullopt).pitch), 90, 1e-6);
  EXPECT_EQ(pointing_.step(), PointingStep::kDown);
  Point({0.1, 0.1, 5}, std::nullopt);
  EXPECT_EQ(pointing_.step(), PointingStep::kSearch);
}

// One that the view straight down does not show is looked at.
TEST_F(PointingTest, LooksAtNearTargetThatIsAside) {
  const Vector3d place(2, 0, 2);
  EXPECT_LT(Off(Point(place, Vector3d::Zero()), -place), 1e-6);
}

// Every place within the range of sight, but for those near the horizon.
TEST_F(PointingTest, SearchShowsEveryPlaceWithinSight) {
  const Vector3d place(0, 0, 10);
  for (const double side_deg : {180.0, 120.0}) {
    pointing_.set_range({.side = Radians(side_deg)});
    for (double distance = 0; distance < 25; distance += 6) {
      for (double bearing_deg = -side_deg; bearing_deg < side_deg; bearing_deg += 60) {
        const double bearing = Radians(bearing_deg);
        const Vector3d ray = distance * Vector3d(std::cos(bearing), std::sin(bearing), 0) - place;
        int seen = 0;
        for (int i = 0; i < 20 * 90; ++i) {
          seen += Off(Point(place, std::nullopt), ray) < Degrees(kNarrow.half_angle) ? 1 : 0;
        }
        EXPECT_GT(seen, 10) << distance << " m, " << bearing_deg << " deg";
      }
    }
  }
}

TEST_F(PointingTest, WideCameraSearchesByLookingDown) {
  GimbalView wide = kNarrow;
  wide.half_angle = Radians(80.0);
  GimbalPointing pointing(wide);
  for (int i = 0; i < 1000; ++i) {
    now_ += std::chrono::milliseconds(50);
    const GimbalAngles angles =
        pointing.Update({now_, {Eigen::Quaterniond::Identity(), {0, 0, 10}}, std::nullopt});
    EXPECT_NEAR(Degrees(angles.pitch), 90, 1e-6);
  }
}

// Search does not turn faster than images stand.
TEST_F(PointingTest, SearchTurnsSlowly) {
  GimbalAngles before = Point({0, 0, 10}, std::nullopt);
  int fast = 0;
  for (int i = 0; i < 20 * 60; ++i) {
    const GimbalAngles angles = Point({0, 0, 10}, std::nullopt);
    fast += Off(angles, before.rotation() * Vector3d::UnitX()) > 1.6 ? 1 : 0;  // 32 deg/s
    before = angles;
  }
  EXPECT_LT(fast, 15);  // from circle to circle
}

}  // namespace
}  // namespace kestrel
