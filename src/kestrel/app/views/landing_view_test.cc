// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/views/landing_view.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/target/plane_warp.h"
#include "kestrel/vision/targets/make_target_detector.h"

namespace kestrel {
namespace {

// A camera 5 m above the world's origin that looks straight down, with its upper edge to the north,
// and a pattern 1 m east of the point below it.
LandingObservation Seen() {
  LandingObservation observation;
  RigidTransform world_from_camera;
  world_from_camera.rotation = Eigen::Quaterniond(Eigen::Vector4d(1, 0, 0, 0));  // x y z w
  world_from_camera.translation = {0, 0, 5};
  observation.world_from_camera = world_from_camera;
  TargetDetection detection{};
  detection.center_px.setZero();
  detection.covariance.setZero();
  detection.camera_from_target = world_from_camera.Inverse();
  detection.camera_from_target.translation = world_from_camera.Inverse() * Eigen::Vector3d(1, 0, 0);
  detection.quality = 0.9;
  observation.report.detection = detection;
  TargetEstimate target{};
  target.motion.mean.head<3>() = Eigen::Vector3d(1, 0, 0);
  target.motion.mean.segment<3>(TurnState::kVelocity) = Eigen::Vector3d(2, 0, 0);
  target.motion.covariance(0, 0) = 0.25;
  target.motion.covariance(1, 1) = 0.01;
  observation.target = target;
  observation.track_state = TrackState::kTracking;
  return observation;
}

LandingView View() {
  return {CameraModel(PaperCamera()), ShapeOf(LandingPattern()), TargetTrackerOptions().Noise()};
}

// Returns the length of the longest drawn piece of a shape.
double LongestPiece(const OverlayShape& shape) {
  const std::size_t count = shape.outline.size();
  double longest = 0;
  for (std::size_t i = shape.is_closed ? 0 : 1; i < count; ++i) {
    longest =
        std::max(longest, cv::norm(shape.outline[i] - shape.outline[(i + count - 1) % count]));
  }
  return longest;
}

cv::Point2f Middle(const OverlayShape& shape) {
  cv::Point2f sum(0, 0);
  for (const cv::Point2f& point : shape.outline) sum += point;
  return sum / static_cast<float>(shape.outline.size());
}

double Width(const OverlayShape& shape, bool is_vertical) {
  float low = 1e9F;
  float high = -1e9F;
  for (const cv::Point2f& point : shape.outline) {
    low = std::min(low, is_vertical ? point.y : point.x);
    high = std::max(high, is_vertical ? point.y : point.x);
  }
  return high - low;
}

TEST(LandingViewTest, TrackEllipseLiesAtRing) {
  const auto shapes = LandingShapes(View(), Seen());
  ASSERT_EQ(shapes.size(), 5U);
  EXPECT_EQ(shapes[0].layer, OverlayLayer::kPrediction);
  EXPECT_EQ(shapes[1].layer, OverlayLayer::kDetection);
  EXPECT_NEAR(cv::norm(Middle(shapes[0]) - Middle(shapes[1])), 0, 2);
  EXPECT_GT(Middle(shapes[1]).x, PaperCamera().cx_px + 20) << "east is right";
  // Two standard deviations of 0.5 m and 0.1 m to either side; the ring is 1 m wide.
  EXPECT_NEAR(Width(shapes[0], false) / Width(shapes[1], false), 2, 0.1);
  EXPECT_NEAR(Width(shapes[0], true) / Width(shapes[1], true), 0.4, 0.05);
}

// The longest side of any of these pads is drawn in 8 pieces, as the print has no diagonals.
TEST(LandingViewTest, DrawsNoLineAcrossPad) {
  for (const char* const kind : {"ring-cross", "apriltag", "aruco", "helipad"}) {
    TargetOptions target;
    target.kind = kind;
    LandingView view = View();
    view.shape = ShapeOfTarget(target, {});
    const auto shapes = LandingShapes(view, Seen());
    ASSERT_EQ(shapes.size(), view.shape.outlines.size() + 2) << kind;
    for (std::size_t i = 1; i + 1 < shapes.size(); ++i) {
      const double size = std::max(Width(shapes[i], false), Width(shapes[i], true));
      EXPECT_TRUE(shapes[i].is_closed) << kind;
      EXPECT_LT(LongestPiece(shapes[i]), 0.15 * size) << kind << ", line " << i;
    }
  }
}

TEST(LandingViewTest, LineEndsAtFieldOfViewOfLens) {
  // A pad so near, beside a lens that shows a part of the world only.
  LandingObservation observation = Seen();
  observation.report.detection->camera_from_target.translation = {0.6, 0, 0.05};
  observation.target.reset();
  LandingView view = View();
  CameraIntrinsics narrow = PaperCamera();
  narrow.distortion_model = DistortionModel::kNone;
  narrow.distortion.clear();
  view.camera = CameraModel(narrow);
  observation.report.detection->camera_from_target.rotation =
      Eigen::Quaterniond(Eigen::AngleAxisd(1.2, Eigen::Vector3d::UnitY()));
  const auto shapes = LandingShapes(view, observation);
  ASSERT_GT(shapes.size(), 1U);
  EXPECT_FALSE(shapes[0].is_closed) << "the ring leaves what the lens shows";
  EXPECT_NE(shapes[0].label, "");
}

TEST(LandingViewTest, ShowsDetectionFarFromTrackAsRejected) {
  LandingObservation observation = Seen();
  observation.fate = MeasurementFate::kFarFromTrack;
  const auto shapes = LandingShapes(View(), observation);
  ASSERT_EQ(shapes.size(), 5U);
  for (int i = 1; i < 5; ++i) EXPECT_EQ(shapes[i].layer, OverlayLayer::kRejected);
  EXPECT_NE(LandingStatus(observation).reason, "");
}

TEST(LandingViewTest, ShowsBothOutlinesOfMisfit) {
  LandingObservation observation = Seen();
  TargetDetection& detection = *observation.report.detection;
  detection.diagnostics.seen =
      SeenPrint{detection.camera_from_target, PlaneWarp::Coefficients::Zero(), 0.5};
  detection.diagnostics.seen->displacement_px(1, 0) = 25;
  detection.diagnostics.misfit_px = 20;
  detection.diagnostics.misfit_bound_px = 1;
  const auto shapes = LandingShapes(View(), observation);
  ASSERT_EQ(shapes.size(), 8U);
  EXPECT_EQ(shapes[1].layer, OverlayLayer::kDetection);
  EXPECT_EQ(shapes[4].layer, OverlayLayer::kRejected);
  const cv::Point2f beside = Middle(shapes[1]) - Middle(shapes[4]);
  EXPECT_NEAR(beside.x, 0, 0.1);
  EXPECT_NEAR(beside.y, 25, 0.1);
  EXPECT_NE(shapes[4].label.find("20.0 px beside"), std::string::npos) << shapes[4].label;
  EXPECT_NE(LandingStatus(observation).reason.find("20.0 px beside"), std::string::npos);
  EXPECT_EQ(LandingFacts(observation).back().value, "20.00 px, at most 1.00 expected");
  EXPECT_EQ(LandingFacts(LandingObservation()).size(), LandingFacts(observation).size());
  detection.diagnostics.misfit_bound_px = 30;
  EXPECT_EQ(LandingShapes(View(), observation).size(), 5U) << "no more than should be";
}

TEST(LandingViewTest, NamesPad) {
  LandingObservation observation = Seen();
  observation.report.detection->method = DetectionMethod::kTags;
  observation.report.detection->id = 17;
  EXPECT_EQ(LandingShapes(View(), observation)[1].label, "pad, by its tags, id 17, 90 %");
  EXPECT_EQ(LandingFacts(observation)[1].value, "pad, by its tags, id 17");
}

TEST(LandingViewTest, ShowsNumbersOfTrack) {
  const ViewSample sample = LandingSample(Seen());
  ASSERT_EQ(sample.values.size(), LandingSeries().size());
  EXPECT_NEAR(sample.values[0], 5, 1e-9);
  EXPECT_NEAR(sample.values[1], 1, 1e-9);
  EXPECT_NEAR(sample.values[2], 2, 1e-9);
  EXPECT_NEAR(sample.values[3], 0.9, 1e-9);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(std::isnan(LandingSample({}).values[i]));
}

TEST(LandingViewTest, MapShowsPrediction) {
  const ViewMap map = LandingMap(View(), Seen());
  EXPECT_NEAR(map.uav_heading, M_PI / 2, 1e-9);
  ASSERT_EQ(map.prediction.size(), 3U);
  EXPECT_NEAR(map.prediction[1].position.x(), 5, 0.1);
  EXPECT_GT(map.prediction[2].covariance(0, 0), map.target->covariance(0, 0));
  EXPECT_FALSE(LandingMap(View(), {}).uav);
}

TEST(LandingViewTest, ReportsReasonOfMiss) {
  LandingObservation observation;
  observation.report.reason = "no ring";
  EXPECT_EQ(LandingStatus(observation).state, "searching");
  EXPECT_NE(LandingStatus(observation).reason.find("no ring"), std::string::npos);
  EXPECT_EQ(LandingStatus(Seen()).reason, "");
  EXPECT_EQ(LandingStatus(Seen()).state, "tracking");
}

TEST(LandingViewTest, SingleSightingIsFoundBeforeTrackExists) {
  LandingObservation observation = Seen();
  observation.track_state = TrackState::kSearching;
  observation.target.reset();
  EXPECT_EQ(LandingStatus(observation).state, "found");
}

TEST(LandingViewTest, ShowsThresholdAtFourResolutionsOfGrayAndColour) {
  cv::Mat board(96, 128, CV_8UC1, cv::Scalar(230));
  board(cv::Rect(40, 24, 32, 32)).setTo(20);
  cv::Mat color;
  cv::merge(std::vector<cv::Mat>(3, board), color);
  const std::vector<ImageView> views = LandingImageViews();
  ASSERT_EQ(views.size(), 4U);
  EXPECT_EQ(views.front().name, "threshold 1/8");
  EXPECT_EQ(views.back().name, "threshold 1/1");
  for (const ImageView& view : views) {
    const cv::Mat drawn = view.draw(board);
    ASSERT_EQ(drawn.size(), board.size()) << view.name;
    EXPECT_EQ(drawn.at<uchar>(26, 42), 0) << view.name;
    EXPECT_EQ(cv::norm(drawn, view.draw(color), cv::NORM_INF), 0) << view.name;
  }
}

}  // namespace
}  // namespace kestrel
