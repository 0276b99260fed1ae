// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/tag_messages.h"

#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <apriltag/apriltag.h>
#include <apriltag/apriltag_pose.h>
#include <apriltag/tag36h11.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/ros/landing_results.h"
#include "kestrel/vision/tags/tag_board_detector.h"
#include "kestrel/vision/tags/test_tag_images.h"

namespace kestrel {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

using Homography = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double kSize = 0.5;  // m
const Time kTaken = TimeFromNanoseconds(7'000'000'000);

// A pinhole camera, of which libapriltag finds the pose as well.
CameraModel Pinhole() {
  CameraIntrinsics intrinsics = PaperCamera();
  intrinsics.distortion_model = DistortionModel::kNone;
  intrinsics.distortion.clear();
  return CameraModel(intrinsics);
}

TagBoard BoardOf(const std::vector<int>& ids) {
  TagBoard board;
  for (const int id : ids) {
    BoardTag tag;
    tag.id = id;
    tag.size_m = kSize;
    tag.board_from_tag.translation.x() = 1.0 * static_cast<double>(board.tags.size());
    board.tags.push_back(tag);
  }
  return board;
}

LandingObservation ObservationOf(const CameraModel& camera, const TagBoard& board,
                                 const cv::Mat& image) {
  const TagBoardDetector detector(camera, board, {});
  const auto workspace = detector.MakeWorkspace();
  LandingObservation observation;
  observation.time = kTaken;
  observation.report = detector.Detect(image, {}, *workspace);
  return observation;
}

class TagMessagesTest : public ::testing::Test {
 protected:
  cv::Mat ImageOf(const TagBoard& board) const {
    return TagRenderer(camera_).Render(board.Printed(), pose_, {}, 1);
  }
  LandingObservation Seen(const TagBoard& board) const {
    return ObservationOf(camera_, board, ImageOf(board));
  }

  const CameraModel camera_ = Pinhole();
  const RigidTransform pose_ = BoardBelow(2.5, {0.2, -0.1}, Radians(50), {0.2, -0.1, 0});
};

// Messages for listeners match libapriltag's results for the same image.
TEST_F(TagMessagesTest, CornersAndHomographyMatchLibapriltag) {
  const TagBoard board = BoardOf({7});
  const cv::Mat image = ImageOf(board);
  const TagArrayMessage message =
      TagsOf(ObservationOf(camera_, board, image), camera_, ShapeOf(board), "camera");
  EXPECT_EQ(message.header.stamp, kTaken);
  EXPECT_EQ(message.header.frame_id, "camera");
  ASSERT_THAT(message.detections, SizeIs(1));
  const TagMessage& tag = message.detections[0];

  const std::unique_ptr<apriltag_family_t, decltype(&tag36h11_destroy)> family(tag36h11_create(),
                                                                               tag36h11_destroy);
  const std::unique_ptr<apriltag_detector_t, decltype(&apriltag_detector_destroy)> detector(
      apriltag_detector_create(), apriltag_detector_destroy);
  apriltag_detector_add_family(detector.get(), family.get());
  image_u8_t view = {.width = image.cols,
                     .height = image.rows,
                     .stride = static_cast<int>(image.step[0]),
                     .buf = image.data};
  const std::unique_ptr<zarray_t, decltype(&apriltag_detections_destroy)> all(
      apriltag_detector_detect(detector.get(), &view), apriltag_detections_destroy);
  ASSERT_EQ(zarray_size(all.get()), 1);
  apriltag_detection_t* expected = nullptr;
  zarray_get(all.get(), 0, static_cast<void*>(&expected));

  EXPECT_EQ(tag.family, expected->family->name);
  EXPECT_EQ(tag.id, expected->id);
  EXPECT_GT(tag.decision_margin, 90);
  constexpr double kNear = 0.5;  // px
  EXPECT_NEAR(tag.center.x, expected->c[0], kNear);
  EXPECT_NEAR(tag.center.y, expected->c[1], kNear);
  for (std::size_t i = 0; i < tag.corners.size(); ++i) {
    EXPECT_NEAR(tag.corners[i].x, expected->p[i][0], kNear) << i;
    EXPECT_NEAR(tag.corners[i].y, expected->p[i][1], kNear) << i;
  }
  const auto mapped = [](const Homography& homography, double x, double y) {
    return (homography * Eigen::Vector3d(x, y, 1)).hnormalized().eval();
  };
  const Homography own = Eigen::Map<const Homography>(tag.homography.data());
  const Homography theirs = Eigen::Map<const Homography>(expected->H->data);
  EXPECT_LT((mapped(own, -1, 1) - mapped(theirs, -1, 1)).norm(), kNear);
  EXPECT_LT((mapped(own, 0.5, -1) - mapped(theirs, 0.5, -1)).norm(), kNear);
}

TEST_F(TagMessagesTest, TransformsHavePosesOfTags) {
  const TagBoard board = BoardOf({7, 3});
  const LandingObservation observation = Seen(board);
  ASSERT_TRUE(observation.report.detection);
  const auto transforms = TagTransformsOf(observation, ShapeOf(board), "camera").transforms;
  ASSERT_THAT(transforms, SizeIs(2));
  EXPECT_EQ(transforms[0].header.frame_id, "camera");
  EXPECT_EQ(transforms[0].child_frame_id, "tag36h11:7");
  EXPECT_EQ(transforms[1].child_frame_id, "tag36h11:3");
  const RigidTransform second = pose_ * board.tags[1].board_from_tag;
  EXPECT_NEAR(transforms[1].transform.translation.x, second.translation.x(), 0.02);
  EXPECT_NEAR(transforms[1].transform.translation.y, second.translation.y(), 0.02);
  EXPECT_NEAR(transforms[1].transform.translation.z, second.translation.z(), 0.05);
  EXPECT_NEAR(std::abs(transforms[1].transform.rotation.w), std::abs(second.rotation.w()), 0.02);
}

TEST_F(TagMessagesTest, MissGivesEmptyList) {
  const TagBoard board = BoardOf({7});
  LandingObservation observation;
  observation.time = kTaken;
  TargetDetection without_tags{};
  without_tags.parts.Add({"ring and cross", std::nullopt, 100});
  LandingObservation of_ring = observation;
  of_ring.report.detection = without_tags;
  for (const LandingObservation& seen : {of_ring, observation}) {
    EXPECT_THAT(TagsOf(seen, camera_, ShapeOf(board), "camera").detections, IsEmpty());
    EXPECT_THAT(TagTransformsOf(seen, ShapeOf(board), "camera").transforms, IsEmpty());
  }
}

// Remembers the topics that were published.
class Published final : public ResultConnection {
 public:
  bool HasSubscribers(ResultTopic /*topic*/) const override { return false; }
  void Publish(ResultTopic topic, const std::string& /*bytes*/) override { topics.insert(topic); }

  std::set<ResultTopic> topics;
};

TEST_F(TagMessagesTest, ArePublishedOnRequest) {
  const TagBoard board = BoardOf({7});
  const LandingObservation observation = Seen(board);
  const auto topics_of = [&](bool requested) {
    LandingResultsOptions options;
    options.apriltag_topics = requested;
    options.shape = ShapeOf(board);
    Published published;
    LandingResults(options, &published).PublishDetection(camera_, observation);
    return published.topics;
  };
  EXPECT_EQ(topics_of(true).count(ResultTopic::kTags), 1u);
  EXPECT_EQ(topics_of(false).count(ResultTopic::kTags), 0u);
  EXPECT_EQ(InfoOf(ResultTopic::kTags).name, "/detections");
}

}  // namespace
}  // namespace kestrel
