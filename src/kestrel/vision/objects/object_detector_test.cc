// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/object_detector.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/vision/objects/test_objects.h"

namespace kestrel {
namespace {

using ::testing::IsEmpty;

class ObjectDetectorTest : public ::testing::Test {
 protected:
  std::vector<ObjectDetection> Detect(const ObjectScene& scene, const ObjectHint& hint) {
    detector_.Detect(scene.Image(), hint, workspace_, &report_);
    return report_.detections;
  }
  std::vector<ObjectDetection> DetectOnGround(const ObjectScene& scene) {
    return Detect(scene, {{}, scene.up(), scene.height_m()});
  }
  // Detections without merged discs.
  std::vector<ObjectDetection> DetectSingle(const ObjectScene& scene, const ObjectHint& hint) {
    std::vector<ObjectDetection> detections = Detect(scene, hint);
    std::erase_if(detections, [](const ObjectDetection& detection) {
      return detection.completeness == Completeness::kMerged;
    });
    return detections;
  }
  std::string NameOf(const ObjectDetection& detection) const {
    return detector_.model().classes[detection.class_index].name;
  }

  ObjectDetector detector_{ObjectCamera(), DefaultObjectModel()};
  ObjectWorkspace workspace_;
  ObjectReport report_;
};

TEST_F(ObjectDetectorTest, FindsDiscsWithClassCentreAndPlace) {
  ObjectScene scene;
  const std::vector<std::pair<cv::Scalar, Eigen::Vector2d>> discs = {
      {kRedPaint, {150, 120}}, {kGreenPaint, {480, 130}}, {kBluePaint, {320, 300}}};
  for (const auto& [paint, pixel] : discs) {
    scene.DrawDisc(scene.PointUnder(pixel, 0.012), 0.1, paint);
  }
  const auto detections = DetectOnGround(scene);
  ASSERT_EQ(detections.size(), 3U);
  const std::vector<std::string> names = {"red", "green", "blue"};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(NameOf(detections[i]), names[i]);
    EXPECT_GT(detections[i].class_probability, 0.9);
    EXPECT_EQ(detections[i].completeness, Completeness::kWhole);
    EXPECT_LT((detections[i].center_px - discs[i].second).norm(), 0.15);
    ASSERT_TRUE(detections[i].location);
    const Eigen::Vector3d truth = scene.PointUnder(discs[i].second, 0.012);
    EXPECT_LT((detections[i].location->position - truth).norm(), 0.025 * truth.norm());
    EXPECT_NEAR(detections[i].bearing.norm(), 1, 1e-9);
  }
}

TEST_F(ObjectDetectorTest, RejectsOtherShapesAsDiscs) {
  ObjectScene scene;
  scene.DrawRectangle(scene.PointUnder({150, 120}, 0), 0.2, 0.2, 0.3, kRedPaint);
  scene.DrawRectangle(scene.PointUnder({400, 120}, 0), 0.4, 0.1, 0.8, kGreenPaint);
  scene.DrawRectangle(scene.PointUnder({300, 350}, 0), 0.5, 0.05, 0.8, kYellowPaint);
  EXPECT_THAT(DetectSingle(scene, {}), IsEmpty());
  EXPECT_GT(report_.passed[static_cast<int>(ObjectStage::kSize)], 2);
}

TEST_F(ObjectDetectorTest, RejectsDiscsOfWrongSizeForGround) {
  ObjectScene scene;
  scene.DrawDisc(scene.PointUnder({150, 120}, 0), 0.2, kRedPaint);
  EXPECT_EQ(DetectSingle(scene, {}).size(), 1U) << "it could be nearer";
  EXPECT_THAT(DetectSingle(scene, {{}, scene.up(), scene.height_m()}), IsEmpty());
}

TEST_F(ObjectDetectorTest, RejectsRing) {
  ObjectScene scene(3);
  const Eigen::Vector3d center = scene.PointUnder({320, 240}, 0.012);
  scene.DrawDisc(center, 0.1, kBluePaint);
  EXPECT_EQ(DetectOnGround(scene).size(), 1U);
  scene.DrawDisc(center, 0.05, cv::Scalar(88, 90, 90));
  EXPECT_THAT(DetectOnGround(scene), IsEmpty());
}

TEST_F(ObjectDetectorTest, RejectsInsideOfLetterOnBanner) {
  const cv::Scalar letter(60, 60, 60);
  const auto draw_letter = [&](const Eigen::Vector2d& pixel, ObjectScene* scene) {
    scene->DrawDisc(scene->PointUnder(pixel, 0), 0.2, letter);
    scene->DrawDisc(scene->PointUnder(pixel, 0), 0.1, kBluePaint);
  };
  ObjectScene banner;
  banner.DrawRectangle(banner.PointUnder({400, 240}, 0), 8, 0.8, 0, kBluePaint);
  draw_letter({150, 240}, &banner);
  draw_letter({634, 240}, &banner);  // half in view
  EXPECT_THAT(DetectSingle(banner, {{}, banner.up(), banner.height_m()}), IsEmpty());
  ObjectScene ground;
  draw_letter({150, 240}, &ground);
  EXPECT_EQ(DetectOnGround(ground).size(), 1U) << "on the ground it may be a disc on a plate";
}

TEST_F(ObjectDetectorTest, FindsCentreOfCutOffDisc) {
  ObjectScene scene;
  const Eigen::Vector2d center(634, 200);
  scene.DrawDisc(scene.PointUnder(center, 0), 0.1, kGreenPaint);
  const auto detections = DetectOnGround(scene);
  ASSERT_EQ(detections.size(), 1U);
  EXPECT_EQ(detections[0].completeness, Completeness::kCutOff);
  EXPECT_LT((detections[0].center_px - center).norm(), 0.7);
}

TEST_F(ObjectDetectorTest, ReportsTouchingDiscsAsMerged) {
  ObjectScene scene;
  const Eigen::Vector3d first = scene.PointUnder({300, 200}, 0);
  scene.DrawDisc(first, 0.1, kGreenPaint);
  scene.DrawDisc(first + Eigen::Vector3d(0, 0.17, 0), 0.1, kGreenPaint);
  const auto detections = DetectOnGround(scene);
  ASSERT_EQ(detections.size(), 1U);
  EXPECT_EQ(detections[0].completeness, Completeness::kMerged);
  EXPECT_FALSE(detections[0].location);
}

TEST_F(ObjectDetectorTest, FindsBarWithPlace) {
  ObjectScene scene(6);
  scene.DrawRectangle(scene.PointUnder({330, 250}, 0.1), 2, 0.15, 0.7, kOrangePaint);
  const auto detections = DetectOnGround(scene);
  ASSERT_EQ(detections.size(), 1U);
  EXPECT_EQ(NameOf(detections[0]), "orange");
  const Eigen::Vector3d truth = scene.PointUnder({330, 250}, 0.1);
  EXPECT_LT((detections[0].location->position - truth).norm(), 0.03 * truth.norm());
}

TEST_F(ObjectDetectorTest, SearchesOnlyNearTrackedObjects) {
  ObjectScene scene;
  scene.DrawDisc(scene.PointUnder({150, 120}, 0), 0.1, kRedPaint);
  scene.DrawDisc(scene.PointUnder({480, 330}, 0), 0.1, kRedPaint);
  const std::vector<TrackedObject> track = {{{470, 310}, 0}};
  const auto detections = Detect(scene, {track, scene.up(), scene.height_m()});
  ASSERT_EQ(detections.size(), 1U);
  EXPECT_LT((detections[0].center_px - Eigen::Vector2d(480, 330)).norm(), 0.2);
  EXPECT_EQ(report_.passed[static_cast<int>(ObjectStage::kSegmented)], 1);
}

TEST_F(ObjectDetectorTest, FindsNothingWithoutColours) {
  EXPECT_THAT(Detect(ObjectScene(), {}), IsEmpty());
  EXPECT_EQ(report_.passed[0], 0);
}

TEST(ObjectDetectorOptions, ReportsViolations) {
  ObjectDetectorOptions options;
  options.min_pixels = 0;
  options.max_gap = 2;
  EXPECT_THAT(ViolationsOf(options), ::testing::SizeIs(2));
  EXPECT_THROW(ObjectDetector(ObjectCamera(), DefaultObjectModel(), options), InputError);
  EXPECT_THROW(ObjectDetector(ObjectCamera(), ObjectModel()), InputError);
}

}  // namespace
}  // namespace kestrel
