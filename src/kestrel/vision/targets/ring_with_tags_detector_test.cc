// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/targets/ring_with_tags_detector.h"

#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/landing/test_landing_detector.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

constexpr int kPadId = 7;
constexpr double kTagSize = 0.2;  // m

// A tag in a corner of the ring's board.
TagBoard Board(int id) {
  BoardTag tag;
  tag.id = id;
  tag.size_m = kTagSize;
  tag.board_from_tag.translation = {0.6, 0.6, 0};
  return {{tag}};
}

class RingWithTagsDetectorTest : public testing::Test {
 protected:
  // The ring and the tags of a board over it.
  Print PadOf(const TagBoard& board) const {
    return [ring = SpokedPrint(pattern_, 4), tags = board.Printed()](double x, double y) {
      for (const PrintedTag& tag : tags) {
        const int column =
            static_cast<int>(std::floor((x - tag.center.x()) / tag.cell_m + 0.5 * tag.grid.width));
        const int row =
            static_cast<int>(std::floor((tag.center.y() - y) / tag.cell_m + 0.5 * tag.grid.width));
        if (column < 0 || row < 0 || column >= tag.grid.width || row >= tag.grid.width) continue;
        return tag.grid.at(column, row) == TagCell::kBlack;
      }
      return ring(x, y);
    };
  }
  cv::Mat Image(const Print& print, const RigidTransform& pose, Random* random) const {
    constexpr double kNoise = 3;
    return AddNoise(DrawPrint(camera_, pattern_, print, pose), kNoise, random);
  }
  TargetReport Detect(const cv::Mat& image, const TargetHint& hint = {}) {
    return detector_.Detect(image, hint, *workspace_);
  }
  TargetReport DetectRing(const cv::Mat& image) const {
    return ring_.Detect(image, {}, *ring_.MakeWorkspace());
  }
  static TargetHint Up(const RigidTransform& pose) {
    TargetHint hint;
    hint.up_in_camera = pose.rotation * Eigen::Vector3d::UnitZ();
    return hint;
  }
  static RigidTransform PoseAt(double height, double turn, Random* random) {
    const double tilt = random->Uniform(0, 0.15);
    const double axis = random->Uniform(-kPi, kPi);
    const double x = random->Uniform(-0.1, 0.1);
    const double y = random->Uniform(-0.1, 0.1);
    return PrintPose({x * height, y * height, height}, tilt, axis, turn);
  }

  const LandingPattern pattern_{};
  const CameraModel camera_{{640, 480, 400, 400, 319.5, 239.5, DistortionModel::kNone, {}}};
  const LandingPatternDetector ring_{camera_, {}};
  const RingWithTagsDetector detector_{camera_, {}, Board(kPadId), {}};
  const std::unique_ptr<TargetWorkspace> workspace_ = detector_.MakeWorkspace();
};

TEST_F(RingWithTagsDetectorTest, TagGivesIdAndHeadingInAllTurns) {
  Random random(3);
  for (const double height : {1.5, 2.5, 3.5, 4.5, 6.0}) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      const RigidTransform pose = PoseAt(height, quarter * kPi / 2 + 0.3, &random);
      const cv::Mat image = Image(PadOf(Board(kPadId)), pose, &random);
      const TargetReport report = Detect(image, Up(pose));
      ASSERT_TRUE(report.detection) << height << " " << report.reason;
      const TargetDetection& found = *report.detection;
      EXPECT_EQ(found.id, kPadId) << height << " " << quarter;
      EXPECT_EQ(found.heading_symmetry, 1);
      const RigidTransform& by_tag = found.camera_from_target;
      EXPECT_LT(by_tag.rotation.angularDistance(pose.rotation), Radians(3)) << height;
      EXPECT_LT((by_tag.translation - pose.translation).norm(), 0.02 * height);
      const std::span<const SeenPart> parts = found.parts.all();
      ASSERT_FALSE(parts.empty());
      EXPECT_EQ(parts.back().tag, 0u);
    }
  }
}

TEST_F(RingWithTagsDetectorTest, PoseComesFromRing) {
  Random random(4);
  const RigidTransform pose = PoseAt(2.5, 0.3 + kPi / 2, &random);
  const cv::Mat image = Image(PadOf(Board(kPadId)), pose, &random);
  const TargetReport report = Detect(image);
  const TargetReport by_ring = DetectRing(image);
  ASSERT_TRUE(report.detection);
  ASSERT_TRUE(by_ring.detection);
  EXPECT_EQ(report.detection->camera_from_target.translation,
            by_ring.detection->camera_from_target.translation);
  EXPECT_EQ(report.detection->covariance, by_ring.detection->covariance);
  EXPECT_EQ(report.detection->method, by_ring.detection->method);
  EXPECT_EQ(report.detection->quality, by_ring.detection->quality);
}

// A tag that is not quite in view is not read, and a ring without a readable tag has no id.
TEST_F(RingWithTagsDetectorTest, NeverAcceptsRingWithAnotherTag) {
  Random random(5);
  int refused = 0;
  for (int i = 0; i < 20; ++i) {
    const int other = random.Integer(kPadId + 1, 586);
    const double height = random.Uniform(1.5, 4.5);
    const RigidTransform pose = PoseAt(height, random.Uniform(-kPi, kPi), &random);
    const cv::Mat image = Image(PadOf(Board(other)), pose, &random);
    ASSERT_TRUE(DetectRing(image).detection);
    const TargetReport report = Detect(image, Up(pose));
    EXPECT_FALSE(report.detection && report.detection->id) << other << " " << height;
    refused += report.reason == "the ring is another pad's: it has another tag of the family";
  }
  EXPECT_GE(refused, 19);
}

TEST_F(RingWithTagsDetectorTest, EqualsRingDetectionWithoutReadableTag) {
  Random random(6);
  for (const double height : {2.0, 4.0, 8.0}) {
    const RigidTransform pose = PoseAt(height, 0.4, &random);
    const cv::Mat image = Image(SpokedPrint(pattern_, 4), pose, &random);
    const TargetReport report = Detect(image);
    ASSERT_TRUE(report.detection);
    ExpectSame(report, DetectRing(image));
    EXPECT_EQ(report.detection->heading_symmetry, 4);
    EXPECT_FALSE(report.detection->id);
  }
}

TEST_F(RingWithTagsDetectorTest, FollowsTagWithoutRingWhenNear) {
  Random random(7);
  // The camera is over the tag.
  const RigidTransform pose = PrintPose({-0.6, 0.6, 0.35}, 0, 0, 0);
  const cv::Mat image = Image(PadOf(Board(kPadId)), pose, &random);
  ASSERT_FALSE(DetectRing(image).detection);
  const TargetReport report = Detect(image, Up(pose));
  ASSERT_TRUE(report.detection) << report.reason;
  EXPECT_EQ(report.detection->id, kPadId);
  EXPECT_EQ(report.detection->method, DetectionMethod::kTags);
  EXPECT_LT((report.detection->camera_from_target.translation - pose.translation).norm(), 0.02);
}

TEST_F(RingWithTagsDetectorTest, ShapeHasRingAndTags) {
  const TargetShape& shape = detector_.shape();
  EXPECT_EQ(shape.diameter_m, pattern_.outer_diameter_m);
  EXPECT_EQ(shape.outlines.size(), ring_.shape().outlines.size());
  ASSERT_EQ(shape.tags.size(), 1u);
  EXPECT_EQ(shape.tags[0].id, kPadId);
}

TEST_F(RingWithTagsDetectorTest, RefusesInvalidInput) {
  EXPECT_THROW(RingWithTagsDetector(camera_, {}, TagBoard(), {}), InputError);
  EXPECT_THROW(RingWithTagsDetector(camera_, {}, Board(kPadId), {.min_quality = 2}), InputError);
  const TargetReport report = Detect(cv::Mat(100, 100, CV_8UC1, cv::Scalar(0)));
  EXPECT_FALSE(report.detection);
  EXPECT_THAT(std::string(report.reason), HasSubstr("not of the camera's size"));
}

}  // namespace
}  // namespace kestrel
