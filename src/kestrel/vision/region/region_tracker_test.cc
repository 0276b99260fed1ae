// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/region/region_tracker.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/vision/region/test_region_scene.h"

namespace kestrel {
namespace {

constexpr double kPeriod_s = 0.05;

double Overlap(const cv::Rect2d& a, const cv::Rect2d& b) {
  const double both = (a & b).area();
  return both / (a.area() + b.area() - both);
}

class RegionTrackerSeeds : public testing::TestWithParam<int> {
 protected:
  void Mark() {
    const cv::Mat image = scene.Take();
    tracker.Mark(image, scene.time, scene.Box());
  }
  RegionReport Next(const std::optional<RegionHint>& hint = std::nullopt) {
    const cv::Mat image = scene.Take();
    return tracker.Track(image, scene.time, hint);
  }
  void HideTarget() {
    RegionThing wall;
    wall.look = RegionTexture({160, 160}, 99, 12);
    wall.center_px = scene.target.center_px;
    scene.cover = wall;
  }

  RegionScene scene{static_cast<std::uint64_t>(100 * GetParam())};
  RegionTracker tracker;
};
INSTANTIATE_TEST_SUITE_P(Seeds, RegionTrackerSeeds, testing::Range(1, 6));

TEST_P(RegionTrackerSeeds, StaysOnAMovingTargetWhileTheCameraMoves) {
  Mark();
  for (int i = 0; i < 60; ++i) {
    scene.target.center_px += Eigen::Vector2d(3, -1);
    scene.camera_px += Eigen::Vector2d(4 * std::sin(0.2 * i), 3 * std::cos(0.15 * i));
    const RegionReport report = Next();
    ASSERT_EQ(report.state, RegionState::kFollowing) << i;
    ASSERT_GT(Overlap(report.box_px, scene.Box()), 0.6) << i;
    ASSERT_GT(report.probability, 0.5) << i;
  }
}

TEST_P(RegionTrackerSeeds, GrowsAndShrinksWithTheTarget) {
  Mark();
  for (int i = 0; i < 80; ++i) {
    scene.target.scale *= i < 40 ? 1.01 : 1 / 1.015;
    const RegionReport report = Next();
    ASSERT_GT(Overlap(report.box_px, scene.Box()), 0.6) << i;
  }
}

TEST_P(RegionTrackerSeeds, StaysOnATargetThatTurns) {
  Mark();
  for (int i = 0; i < 20; ++i) {
    scene.target.turn_deg += 30 * kPeriod_s;
    scene.target.center_px += Eigen::Vector2d(2, 1);
    const RegionReport report = Next();
    const cv::Rect2d& box = report.box_px;
    const Eigen::Vector2d center(box.x + 0.5 * (box.width - 1), box.y + 0.5 * (box.height - 1));
    ASSERT_LT((center - scene.InImage()).norm(), 12) << i;
  }
}

// A car whose side turns to the camera.
TEST_P(RegionTrackerSeeds, BoxTakesFormOfTargetThatTurns) {
  cv::Mat look = RegionTexture({32, 76}, static_cast<std::uint64_t>(GetParam()), 12);
  look += cv::Scalar(-60, 90, 10);
  scene.target.look = look;
  Mark();
  RegionReport report;
  for (int i = 0; i < 60; ++i) {
    scene.target.turn_deg += 30 * kPeriod_s;
    scene.target.center_px += Eigen::Vector2d(2, 1);
    report = Next();
    ASSERT_EQ(report.state, RegionState::kFollowing) << i;
  }
  const Eigen::Vector2d at = scene.InImage();
  EXPECT_GT(Overlap(report.box_px, {at.x() - 38, at.y() - 16, 76, 32}),
            0.35);  // its form as marked has 0.27
}

// The ground in the box is not learnt as part of the region.
TEST_P(RegionTrackerSeeds, BoxKeepsItsMarginAroundTarget) {
  scene.target.look = RegionTexture({40, 52}, static_cast<std::uint64_t>(GetParam()), 12);
  scene.target.look += cv::Scalar(90, -60, 10);
  const cv::Mat image = scene.Take();
  const Eigen::Vector2d at = scene.InImage();
  const auto wide = [](const Eigen::Vector2d& middle) {
    return cv::Rect2d(middle.x() - 24, middle.y() - 30, 48, 60);
  };
  tracker.Mark(image, scene.time, wide(at));
  RegionReport report;
  for (int i = 0; i < 100; ++i) {
    scene.target.center_px += Eigen::Vector2d(2, 1);
    report = Next();
  }
  EXPECT_GT(Overlap(report.box_px, wide(scene.InImage())), 0.7);
}

TEST_P(RegionTrackerSeeds, IsLostWithinHalfASecondAndFoundAgainWithinOne) {
  Mark();
  for (int i = 0; i < 20; ++i) Next();
  HideTarget();
  for (int i = 0; i < 30; ++i) {
    const RegionReport report = Next();
    if (i * kPeriod_s > 0.6) {
      ASSERT_EQ(report.state, RegionState::kLost) << i;
    }
  }
  scene.cover.reset();
  scene.target.center_px += Eigen::Vector2d(60, 20);
  int images = 0;
  RegionReport report = Next();
  for (; images < 20 && report.state != RegionState::kFollowing; ++images) report = Next();
  ASSERT_EQ(report.state, RegionState::kFollowing);
  EXPECT_GT(Overlap(report.box_px, scene.Box()), 0.5);
}

// A car under a bridge: it comes out on another course than it went in.
TEST_P(RegionTrackerSeeds, TargetThatTurnedWhileHiddenIsFoundByItsColors) {
  scene.target.look = RegionTexture({44, 64}, static_cast<std::uint64_t>(GetParam()), 12);
  scene.target.look += cv::Scalar(-60, 90, 10);
  Mark();
  for (int i = 0; i < 20; ++i) Next();
  HideTarget();
  for (int i = 0; i < 30; ++i) Next();
  scene.cover.reset();
  scene.target.turn_deg += 90;
  scene.target.center_px += Eigen::Vector2d(30, 20);
  RegionReport report;
  for (int i = 0; i < 20; ++i) report = Next();
  ASSERT_EQ(report.state, RegionState::kFollowing);
  const Eigen::Vector2d at = scene.InImage();
  EXPECT_GT(Overlap(report.box_px, {at.x() - 32, at.y() - 22, 64, 44}), 0.5);
}

// The other thing has the target's brightness, but another form.
TEST_P(RegionTrackerSeeds, GrayThingFarAwayIsNotFoundByItsBrightness) {
  const auto gray = [](const cv::Size& size, int seed) {
    const cv::Mat look = RegionTexture(size, static_cast<std::uint64_t>(seed), 3);
    return cv::Mat(look + cv::Scalar(100, 100, 100));
  };
  scene.target.look = gray({44, 64}, GetParam());
  Mark();
  for (int i = 0; i < 20; ++i) Next();
  RegionThing other;
  other.look = gray({64, 44}, 50 + GetParam());
  other.center_px = scene.target.center_px + Eigen::Vector2d(-270, 0);
  scene.other = other;
  HideTarget();
  for (int i = 0; i < 60; ++i) {
    const RegionReport report = Next();
    if (report.state != RegionState::kFollowing) continue;
    const Eigen::Vector2d at = scene.InImage();
    ASSERT_LT(std::abs(report.box_px.x + 0.5 * report.box_px.width - at.x()), 100) << i;
  }
}

// So slowly that the filter which learns each image would learn the tree.
TEST_P(RegionTrackerSeeds, TreeThatHidesTargetSlowlyIsNotFollowed) {
  constexpr double kSpeed = 0.5;  // px per image
  scene.target.look = RegionTexture({40, 52}, static_cast<std::uint64_t>(GetParam()), 12);
  scene.target.look += cv::Scalar(-60, 90, 10);
  Mark();
  for (int i = 0; i < 20; ++i) Next();
  RegionThing tree;
  tree.look = RegionTexture({60, 100}, static_cast<std::uint64_t>(50 + GetParam()), 8);
  tree.look += cv::Scalar(-40, -40, -60);
  tree.center_px = scene.target.center_px + Eigen::Vector2d(50, 0);
  scene.cover = tree;
  while (scene.target.center_px.x() < tree.center_px.x()) {
    scene.target.center_px.x() += kSpeed;
    Next();
  }
  for (int i = 0; i < 40; ++i) {
    const RegionReport report = Next();
    if (i > 12) {
      ASSERT_NE(report.state, RegionState::kFollowing) << i;
    }
  }
}

// The camera turns away within a second: what the border repeats is not followed.
TEST_P(RegionTrackerSeeds, IsLostBeyondTheImage) {
  Mark();
  for (int i = 0; i < 40; ++i) {
    scene.camera_px.y() -= 15;
    const RegionReport report = Next();
    if (report.state != RegionState::kFollowing) continue;
    const cv::Rect2d& box = report.box_px;
    EXPECT_LT(box.y + 0.5 * box.height, kRegionImageHeight + 1) << i;
  }
}

TEST_P(RegionTrackerSeeds, NeverFollowsAnotherThingInItsPlace) {
  Mark();
  for (int i = 0; i < 20; ++i) Next();
  RegionThing other = scene.target;
  other.look = RegionTexture({40, 52}, 7, 30);
  other.center_px += Eigen::Vector2d(-150, 0);
  scene.other = other;
  for (int i = 0; i < 100; ++i) {
    scene.other->center_px.x() += 3;
    if (i == 50) HideTarget();
    const RegionReport report = Next();
    if (report.state != RegionState::kFollowing || i > 52) continue;
    const double on_other =
        (scene.other->center_px - scene.target.center_px).norm() < 45 ? 0.0 : 0.3;
    ASSERT_GT(Overlap(report.box_px, scene.Box()), on_other) << i;
  }
}

TEST_P(RegionTrackerSeeds, AHintMakesUpForATurnOfTheCamera) {
  Mark();
  for (int i = 0; i < 20; ++i) {
    scene.camera_px += Eigen::Vector2d(i < 10 ? 14 : -14, 0);
    scene.target.center_px += Eigen::Vector2d(i < 10 ? 60 : -60, 0);
    scene.camera_px += Eigen::Vector2d(i < 10 ? 40 : -40, 0);
    const RegionHint hint{scene.InImage() + Eigen::Vector2d(5, -4),
                          25 * Eigen::Matrix2d::Identity()};
    const RegionReport report = Next(hint);
    ASSERT_EQ(report.state, RegionState::kFollowing) << i;
    ASSERT_GT(Overlap(report.box_px, scene.Box()), 0.6) << i;
  }
}

TEST_P(RegionTrackerSeeds, FollowsATargetOfEightPixels) {
  scene.target.scale = 0.2;
  Mark();
  for (int i = 0; i < 40; ++i) {
    scene.target.center_px += Eigen::Vector2d(1.5, 1);
    const RegionReport report = Next();
    ASSERT_GT(Overlap(report.box_px, scene.Box()), 0.4) << i;
  }
}

TEST(RegionTracker, AnImageOfAnotherTypeOrSizeIsReportedAsLost) {
  RegionScene scene(1);
  RegionTracker tracker;
  const cv::Mat image = scene.Take();
  EXPECT_EQ(tracker.Track(image, scene.time).state, RegionState::kLost);
  tracker.Mark(image, scene.time, scene.Box());
  cv::Mat gray;
  cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  EXPECT_EQ(tracker.Track(gray, scene.time).state, RegionState::kLost);
}

TEST(RegionTracker, RefusesABoxOutsideOfTheImageOfNoSizeOrNotANumber) {
  RegionScene scene(1);
  RegionTracker tracker;
  const cv::Mat image = scene.Take();
  const auto message = [&](const cv::Rect2d& box) -> std::string {
    try {
      tracker.Mark(image, scene.time, box);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({700, 10, 20, 20}),
            "box 700,10,20,20: expected one within the image of 640 x 480");
  EXPECT_EQ(message({10, 10, 0, 20}),
            "box 10,10,0,20: expected x,y,width,height in px, width and height at least 4");
  EXPECT_THAT(message({std::numeric_limits<double>::quiet_NaN(), 10, 20, 20}),
              testing::HasSubstr("expected x,y,width,height in px"));
}

}  // namespace
}  // namespace kestrel
