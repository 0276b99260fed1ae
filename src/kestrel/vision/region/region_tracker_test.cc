// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/region/region_tracker.h"

#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "../../../../tests/count_allocations.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

constexpr double kPeriod_s = 0.05;
constexpr int kWidth = 640, kHeight = 480;

// Blotches of several sizes in colour.
cv::Mat Texture(const cv::Size& size, std::uint64_t seed, double contrast) {
  Random random(seed);
  cv::Mat sum(size, CV_32FC3, cv::Scalar::all(0));
  for (const int cell : {3, 9, 27}) {
    cv::Mat coarse(size.height / cell + 2, size.width / cell + 2, CV_32FC3);
    for (int y = 0; y < coarse.rows; ++y) {
      for (int x = 0; x < coarse.cols; ++x) {
        for (int c = 0; c < 3; ++c) {
          coarse.at<cv::Vec3f>(y, x)[c] = static_cast<float>(contrast * random.Normal());
        }
      }
    }
    cv::Mat large;
    cv::resize(coarse, large, size, 0, 0, cv::INTER_CUBIC);
    sum += large;
  }
  cv::Mat texture;
  sum.convertTo(texture, CV_8UC3, 1, 110);
  return texture;
}

// A thing on the ground.
struct Thing {
  cv::Mat look;
  Eigen::Vector2d center_px = {0, 0};  // on the ground
  double scale = 1, turn_deg = 0;
};

// Ground with things on it, seen by a camera that moves.
class Scene {
 public:
  explicit Scene(std::uint64_t seed) : random_(seed), ground_(Texture({1400, 1000}, seed + 1, 9)) {
    target.look = Texture({40, 52}, seed + 2, 30);
    target.center_px = {600, 480};
  }

  cv::Mat Take() {
    cv::Mat image;
    const cv::Matx23f shift(1, 0, static_cast<float>(-camera_px.x()), 0, 1,
                            static_cast<float>(-camera_px.y()));
    cv::warpAffine(ground_, image, shift, {kWidth, kHeight}, cv::INTER_LINEAR, cv::BORDER_REFLECT);
    Draw(target, &image);
    if (other) Draw(*other, &image);
    if (cover) Draw(*cover, &image);
    cv::Mat noise(image.size(), CV_8UC3);
    for (int y = 0; y < image.rows; ++y) {
      auto* row = noise.ptr<std::uint8_t>(y);
      for (int i = 0; i < 3 * image.cols; ++i)
        row[i] = static_cast<std::uint8_t>(random_.Bits() & 7);
    }
    cv::add(image, noise, image);
    time += std::chrono::milliseconds(50);
    return image;
  }

  Eigen::Vector2d InImage() const { return target.center_px - camera_px; }
  cv::Rect2d Box() const {
    const Eigen::Vector2d size = target.scale * Eigen::Vector2d(target.look.cols, target.look.rows);
    const Eigen::Vector2d corner = InImage() - 0.5 * (size - Eigen::Vector2d::Ones());
    return {corner.x(), corner.y(), size.x(), size.y()};
  }

  Thing target;
  std::optional<Thing> other, cover;
  Eigen::Vector2d camera_px = {280, 240};  // of the image's corner on the ground
  Time time{};

 private:
  void Draw(const Thing& thing, cv::Mat* image) const {
    const Eigen::Vector2d at = thing.center_px - camera_px;
    const cv::Point2f middle(0.5f * static_cast<float>(thing.look.cols - 1),
                             0.5f * static_cast<float>(thing.look.rows - 1));
    cv::Mat map = cv::getRotationMatrix2D(middle, thing.turn_deg, thing.scale);
    map.at<double>(0, 2) += at.x() - middle.x;
    map.at<double>(1, 2) += at.y() - middle.y;
    cv::warpAffine(thing.look, *image, map, image->size(), cv::INTER_LINEAR,
                   cv::BORDER_TRANSPARENT);
  }

  Random random_;
  cv::Mat ground_;
};

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
    Thing wall;
    wall.look = Texture({160, 160}, 99, 12);
    wall.center_px = scene.target.center_px;
    scene.cover = wall;
  }

  Scene scene{static_cast<std::uint64_t>(100 * GetParam())};
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
  for (int i = 0; i < 45; ++i) {
    scene.target.turn_deg += 2;
    scene.target.center_px += Eigen::Vector2d(2, 1);
    const RegionReport report = Next();
    const cv::Rect2d& box = report.box_px;
    const Eigen::Vector2d center(box.x + 0.5 * (box.width - 1), box.y + 0.5 * (box.height - 1));
    ASSERT_LT((center - scene.InImage()).norm(), 12) << i;
  }
}

TEST_P(RegionTrackerSeeds, IsLostWithinHalfASecondAndFoundAgainWithinOne) {
  Mark();
  for (int i = 0; i < 20; ++i) Next();
  HideTarget();
  for (int i = 0; i < 30; ++i) {
    const RegionReport report = Next();
    if (i * kPeriod_s > 0.6) ASSERT_EQ(report.state, RegionState::kLost) << i;
  }
  scene.cover.reset();
  scene.target.center_px += Eigen::Vector2d(60, 20);
  int images = 0;
  RegionReport report = Next();
  for (; images < 20 && report.state != RegionState::kFollowing; ++images) report = Next();
  ASSERT_EQ(report.state, RegionState::kFollowing);
  EXPECT_GT(Overlap(report.box_px, scene.Box()), 0.5);
}

TEST_P(RegionTrackerSeeds, NeverFollowsAnotherThingInItsPlace) {
  Mark();
  for (int i = 0; i < 20; ++i) Next();
  Thing other = scene.target;
  other.look = Texture({40, 52}, 7, 30);
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

TEST_P(RegionTrackerSeeds, DoesNotAllocate) {
  Mark();
  Next();
  for (int i = 0; i < 40; ++i) {
    if (i == 10) HideTarget();
    if (i == 30) scene.cover.reset();
    const cv::Mat image = scene.Take();
    allocation_count = 0;
    is_counting = true;
    tracker.Track(image, scene.time);
    is_counting = false;
    ASSERT_EQ(allocation_count, 0) << i;
  }
}

TEST(RegionTracker, AnImageOfAnotherTypeOrSizeIsReportedAsLost) {
  Scene scene(1);
  RegionTracker tracker;
  const cv::Mat image = scene.Take();
  EXPECT_EQ(tracker.Track(image, scene.time).state, RegionState::kLost);
  tracker.Mark(image, scene.time, scene.Box());
  cv::Mat gray;
  cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  EXPECT_EQ(tracker.Track(gray, scene.time).state, RegionState::kLost);
}

TEST(RegionTracker, RefusesABoxOutsideOfTheImageOfNoSizeOrNotANumber) {
  Scene scene(1);
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
