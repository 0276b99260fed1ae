// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/targets/make_target_detector.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/vision/landing/test_landing_detector.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using MakeTargetDetectorTest = LandingPatternDetectorTest;

TEST_F(MakeTargetDetectorTest, RingIsDefault) {
  const auto detector = MakeTargetDetector(camera_, TargetOptions(), {});
  const auto workspace = detector->MakeWorkspace();
  const TargetReport report = detector->Detect(image_, {}, *workspace);
  ExpectSame(report, Detect(image_));
  ASSERT_TRUE(report.detection);
  EXPECT_EQ(report.detection->heading_symmetry, 4);
  EXPECT_FALSE(report.detection->id);
  EXPECT_EQ(detector->shape().diameter_m, pattern_.outer_diameter_m);
}

TEST_F(MakeTargetDetectorTest, DetectsInOneImageWithoutHintAndWorkspace) {
  const LandingPatternDetector ring(camera_, {});
  ExpectSame(ring.Detect(image_), Detect(image_));
  for (const char* kind : {"ring-cross", "apriltag", "aruco", "helipad"}) {
    TargetOptions target;
    target.kind = kind;
    const auto detector = MakeTargetDetector(camera_, target);
    const auto workspace = detector->MakeWorkspace();
    ExpectSame(detector->Detect(image_), detector->Detect(image_, {}, *workspace));
    for (const cv::Mat& other : {cv::Mat(), cv::Mat(image_.size(), CV_8UC3)}) {
      const TargetReport report = detector->Detect(other);
      EXPECT_FALSE(report.detection) << kind;
      EXPECT_THAT(std::string(report.reason), HasSubstr("of the camera's size")) << kind;
    }
    target.size_m = NAN;
    EXPECT_THROW(MakeTargetDetector(camera_, target), InputError) << kind;
  }
}

TEST_F(MakeTargetDetectorTest, UsesOptionsOfRing) {
  LandingPatternDetectorOptions ring;
  ring.pattern.outer_diameter_m = 0.8;
  ring.pattern.arm_half_length_m = 0.3;
  EXPECT_EQ(MakeTargetDetector(camera_, {}, ring)->shape().diameter_m, 0.8);
  EXPECT_EQ(ShapeOfTarget({}, ring).diameter_m, 0.8);
  ring.min_quality = 2;
  EXPECT_THROW(MakeTargetDetector(camera_, {}, ring), InputError);
}

TEST_F(MakeTargetDetectorTest, SizeScalesPadsOfAllKinds) {
  for (const char* kind : {"ring-cross", "apriltag", "aruco", "helipad"}) {
    TargetOptions target;
    target.kind = kind;
    const TargetPrint own = PrintOfTarget(target, {});
    target.size_m = 0.5 * (target.kind == "ring-cross" ? 1.0
                           : target.kind == "helipad"  ? 1.5
                                                       : 0.5);
    const TargetPrint half = PrintOfTarget(target, {});
    EXPECT_NEAR(half.board_size_m, 0.5 * own.board_size_m, 1e-12) << kind;
    EXPECT_NEAR(InkSize(half), 0.5 * InkSize(own), 1e-12) << kind;
    EXPECT_NEAR(MakeTargetDetector(camera_, target, {})->shape().diameter_m,
                ShapeOfTarget(target, {}).diameter_m, 1e-12)
        << kind;
    target.size_m = 160;
    EXPECT_THAT(ViolationsOf(target), ElementsAre("size_m is 160, expected metres: 0.16?"));
    target.size_m = -1;
    EXPECT_THAT(ViolationsOf(target), ElementsAre("size_m is -1, expected more than 0"));
  }
}

TEST_F(MakeTargetDetectorTest, UnknownKindErrorListsKinds) {
  TargetOptions target;
  SetOption("kind=ring-cros", &target);
  try {
    MakeTargetDetector(camera_, target, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'ring-cros', expected one of ring-cross"));
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'ring-cross'?"));
  }
}

TEST_F(MakeTargetDetectorTest, AcceptsBoardsOfTagsAsKinds) {
  TargetOptions target;
  SetOption("kind=apriltag", &target);
  SetOption("apriltag.size_m=0.3", &target);
  EXPECT_NEAR(MakeTargetDetector(camera_, target, {})->shape().outlines[0][0].norm(),
              0.15 * M_SQRT2, 1e-9);
  SetOption("kind=aruco", &target);
  EXPECT_NEAR(ShapeOfTarget(target, {}).outlines[0][0].norm(), 0.25 * M_SQRT2, 1e-9);
  SetOption("aruco.id=50", &target);
  EXPECT_THAT(ViolationsOf(target), ElementsAre(HasSubstr("has no id 50")));
  SetOption("kind=nested", &target);
  EXPECT_THAT(ViolationsOf(target), ElementsAre(HasSubstr("nested.board is empty")));
  // The options of other kinds do not matter.
  SetOption("kind=ring-cross", &target);
  EXPECT_TRUE(ViolationsOf(target).empty());
}

TEST(TargetOptions, WarnsOfIdAsPlainAsWindow) {
  TargetOptions target;
  EXPECT_TRUE(target.Warnings().empty());
  SetOption("kind=aruco", &target);
  EXPECT_TRUE(target.Warnings().empty());
  SetOption("id=17", &target);
  EXPECT_THAT(target.Warnings(), ElementsAre(HasSubstr("aruco_4x4_50 id 17 is as plain")));
}

TEST(TargetOptions, AcceptsIdForSingleTagKindsOnly) {
  TargetOptions target;
  SetOption("id=9", &target);
  EXPECT_THAT(ViolationsOf(target), ElementsAre("id is 9, but a ring-cross has no id"));
  SetOption("kind=helipad", &target);
  EXPECT_THAT(ViolationsOf(target), ElementsAre("id is 9, but a helipad has no id"));
  SetOption("kind=apriltag", &target);
  EXPECT_TRUE(ViolationsOf(target).empty());
  const TargetShape shape = ShapeOfTarget(target, {});
  ASSERT_EQ(shape.tags.size(), 1u);
  EXPECT_EQ(shape.tags[0].id, 9);
  SetOption("id=587", &target);
  EXPECT_THAT(ViolationsOf(target), ElementsAre(HasSubstr("tag36h11 has no id 587")));
}

}  // namespace
}  // namespace kestrel
