// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/hunt_pipeline.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/vision/objects/test_objects.h"
#include "kestrel/vision/pipeline/ground_height.h"

namespace kestrel {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kHeight_m = 4;

CameraCalibration Calibration() {
  CameraCalibration calibration;
  calibration.intrinsics = ObjectCamera().intrinsics();
  // Looks straight down, its rows along the body's x.
  calibration.body_from_camera = RigidTransform{
      Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX())),
      Eigen::Vector3d::Zero()};
  return calibration;
}

Time At(double seconds) { return Time(DurationFromSeconds(seconds)); }

// Draws red discs on the ground below a camera that looks straight down from 4 m.
cv::Mat DrawDiscs(const std::vector<Eigen::Vector2d>& pixels) {
  ObjectScene scene(kHeight_m, /*tilt=*/0);
  for (const Eigen::Vector2d& pixel : pixels) {
    scene.DrawDisc(scene.PointUnder(pixel, 0.012), 0.1, kRedPaint);
  }
  return scene.Image();
}

RigidTransform Over(double x, double y) {
  return {Eigen::Quaterniond::Identity(), {x, y, kHeight_m}};
}

TEST(HuntPipeline, LocatesObjectsInWorld) {
  HuntPipeline pipeline(Calibration(), DefaultObjectModel(), {});
  const cv::Mat image = DrawDiscs({{420, 140}});
  for (int i = 0; i < 5; ++i) {
    pipeline.AddPose({At(i), Over(10, 20)});
    const HuntObservation& seen = pipeline.Process(image, At(i));
    ASSERT_THAT(seen.report.detections, SizeIs(1));
    ASSERT_TRUE(seen.in_world[0]);
    // 100.5 px right and 99.5 px up, at a focal length of 500 px and a distance of 4 m.
    const Eigen::Vector3d expected(10 + 100.5 / 500 * 3.988, 20 + 99.5 / 500 * 3.988, 0.012);
    // A thirtieth of a pixel in the radius is 1 cm of distance.
    EXPECT_LT((seen.in_world[0]->position - expected).norm(), 0.01);
  }
  const auto objects = pipeline.map().Confirmed();
  ASSERT_THAT(objects, SizeIs(1));
  EXPECT_EQ(objects[0].detections, 5);
  EXPECT_EQ(ScoreOf(objects[0], DefaultObjectModel()), 1);
}

TEST(HuntPipeline, GivesDistanceButNoMapWithoutPoses) {
  HuntPipeline pipeline(Calibration(), DefaultObjectModel(), {});
  const HuntObservation& seen = pipeline.Process(DrawDiscs({{320, 240}}), At(0));
  ASSERT_THAT(seen.report.detections, SizeIs(1));
  EXPECT_NEAR(seen.report.detections[0].location->position.norm(), 3.988, 0.1);
  EXPECT_FALSE(seen.in_world[0]);
  EXPECT_THAT(pipeline.map().objects(), IsEmpty());
}

TEST(HuntPipeline, DiscardsWrongSizeBesideRightOnes) {
  HuntPipeline pipeline(Calibration(), DefaultObjectModel(), {});
  ObjectScene scene(kHeight_m, /*tilt=*/0);
  scene.DrawDisc(scene.PointUnder({150, 150}, 0.012), 0.1, kRedPaint);
  scene.DrawDisc(scene.PointUnder({450, 150}, 0.012), 0.1, kRedPaint);
  scene.DrawDisc(scene.PointUnder({320, 350}, 0.012), 0.2, kRedPaint);
  pipeline.SetAltitude(kHeight_m);
  const HuntObservation& seen = pipeline.Process(scene.Image(), At(0));
  ASSERT_THAT(seen.report.detections, SizeIs(2));
  for (const ObjectDetection& detection : seen.report.detections) {
    EXPECT_NEAR(detection.center_px.y(), 150, 1);
  }
}

TEST(HuntPipeline, WrongAltitudeDoesNotHideObjects) {
  for (const double given_m : {1.5, 6.0, 14.0}) {
    HuntPipeline pipeline(Calibration(), DefaultObjectModel(), {});
    pipeline.SetAltitude(given_m);
    const cv::Mat image = DrawDiscs({{320, 240}, {420, 140}});
    for (int i = 0; i < 10; ++i) {
      EXPECT_EQ(pipeline.ground_contradiction().has_value(), i >= 5);
      const HuntObservation& seen = pipeline.Process(image, At(i));
      ASSERT_THAT(seen.report.detections, SizeIs(2)) << given_m << " m told, frame " << i;
      EXPECT_NEAR(seen.report.detections[0].location->position.z(), 3.988, 0.1);
    }
    EXPECT_NEAR(pipeline.ground_contradiction()->height_m, given_m - kHeight_m, 0.1);
  }
}

TEST(HuntPipeline, CorrectsWrongNavigationHeightBySightings) {
  for (const double error_m : {-2.0, 2.0, 10.0, 500.0}) {
    HuntPipeline pipeline(Calibration(), DefaultObjectModel(), {});
    const cv::Mat image = DrawDiscs({{420, 140}, {200, 300}});
    for (int i = 0; i < 10; ++i) {
      pipeline.AddPose({At(i), {Eigen::Quaterniond::Identity(), {10, 20, kHeight_m + error_m}}});
      const HuntObservation& seen = pipeline.Process(image, At(i));
      ASSERT_THAT(seen.report.detections, SizeIs(2)) << error_m << " m, frame " << i;
      const Eigen::Vector3d expected(10 + 100.5 / 500 * 3.988, 20 + 99.5 / 500 * 3.988,
                                     0.012 + error_m);
      EXPECT_LT((seen.in_world[0]->position - expected).norm(), 0.15) << error_m << " m";
    }
    ASSERT_TRUE(pipeline.ground_contradiction());
    EXPECT_NEAR(pipeline.ground_contradiction()->height_m, error_m, 0.1);
    EXPECT_THAT(pipeline.map().Confirmed(), SizeIs(2));
  }
}

TEST(HuntPipeline, UsesPoseOfEachRowOfRollingShutter) {
  HuntPipelineOptions options;
  options.readout_s = 0.1;
  HuntPipeline pipeline(Calibration(), DefaultObjectModel(), options);
  for (int i = 0; i < 20; ++i) pipeline.AddPose({At(0.05 * i), Over(0.05 * i * 3, 0)});  // 3 m/s
  const HuntObservation& seen = pipeline.Process(DrawDiscs({{320, 60}, {320, 420}}), At(0.5));
  ASSERT_THAT(seen.report.detections, SizeIs(2));
  const double upper = seen.in_world[0]->position.x();
  const double lower = seen.in_world[1]->position.x();
  EXPECT_NEAR(lower - upper, 3 * 0.1 * 360 / 479, 0.02);
  EXPECT_NEAR(0.5 * (lower + upper), 3 * 0.5, 0.02);
}

TEST(HuntPipeline, AppliesClockOffsetToPoses) {
  CameraCalibration calibration = Calibration();
  calibration.clock_offset = DurationFromSeconds(0.2);
  HuntPipeline pipeline(calibration, DefaultObjectModel(), {});
  for (int i = 0; i < 20; ++i) pipeline.AddPose({At(0.05 * i), Over(0.05 * i * 3, 0)});
  const HuntObservation& seen = pipeline.Process(DrawDiscs({{319.5, 240}}), At(0.5));
  ASSERT_THAT(seen.report.detections, SizeIs(1));
  EXPECT_NEAR(seen.in_world[0]->position.x(), 3 * 0.7, 0.02);
}

// True when a yellow disc at the origin, over which the UAV flies to and fro, was ever reported as
// moving although only the clock offset is wrong, by 60 ms.
bool IsReportedToMove(const HuntPipelineOptions& options) {
  constexpr double kTop_m = 0.14;
  constexpr double kClockError_s = 0.06;
  const auto east = [](double time_s) { return 1.5 * std::sin(2 * time_s); };
  HuntPipeline pipeline(Calibration(), DefaultObjectModel(), options);
  for (int i = 0; i < 900; ++i) {
    pipeline.AddPose({At(0.01 * i + kClockError_s), Over(east(0.01 * i), 0)});
  }
  bool is_reported = false;
  for (int i = 5; i < 80; ++i) {
    const double u_px = 319.5 - east(0.1 * i) / (kHeight_m - kTop_m) * 500;
    ObjectScene scene(kHeight_m, /*tilt=*/0);
    scene.DrawDisc(scene.PointUnder({u_px, 239.5}, kTop_m), 0.1, kYellowPaint);
    pipeline.Process(scene.Image(), At(0.1 * i));
    EXPECT_THAT(pipeline.map().objects(), SizeIs(1));
    is_reported = is_reported || pipeline.map().objects().front().moves;
  }
  return is_reported;
}

TEST(HuntPipeline, WrongClockDoesNotMoveStandingObject) {
  HuntPipelineOptions options;
  EXPECT_FALSE(IsReportedToMove(options));
  options.map.clock_sigma_s = 0;
  EXPECT_TRUE(IsReportedToMove(options)) << "else it proves nothing";
}

TEST(HuntPipeline, TracksGivenCountAndSearchesWhenOneIsLost) {
  HuntPipelineOptions options;
  options.track_count = 1;
  HuntPipeline pipeline(Calibration(), DefaultObjectModel(), options);
  EXPECT_THAT(pipeline.Process(DrawDiscs({{200, 100}, {450, 300}}), At(0)).report.detections,
              SizeIs(2));
  EXPECT_THAT(pipeline.Process(DrawDiscs({{205, 105}, {450, 300}}), At(1)).report.detections,
              SizeIs(1));
  const auto& found = pipeline.Process(DrawDiscs({{500, 400}}), At(2)).report.detections;
  ASSERT_THAT(found, SizeIs(1)) << "far from where the other one was";
  EXPECT_NEAR(found[0].center_px.x(), 500, 1);
}

TEST(HuntPipeline, GivesNoMapForIndependentFrames) {
  HuntPipelineOptions options;
  options.still = true;
  HuntPipeline pipeline(Calibration(), DefaultObjectModel(), options);
  pipeline.AddPose({At(0), Over(0, 0)});
  EXPECT_TRUE(pipeline.Process(DrawDiscs({{320, 240}}), At(0)).in_world[0]);
  EXPECT_THAT(pipeline.map().objects(), IsEmpty());
}

TEST(HuntPipeline, ChangedOptionsKeepMap) {
  HuntPipeline pipeline(Calibration(), DefaultObjectModel(), {});
  const cv::Mat image = DrawDiscs({{420, 140}});
  for (int i = 0; i < 4; ++i) {
    pipeline.AddPose({At(i), Over(10, 20)});
    pipeline.Process(image, At(i));
  }
  HuntPipelineOptions options;
  options.detector.min_pixels = 100000;
  pipeline.ChangeOptions(options);
  EXPECT_THAT(pipeline.Process(image, At(3.1)).report.detections, IsEmpty());
  EXPECT_THAT(pipeline.map().Confirmed(), SizeIs(1));
  options.detector.min_pixels = 0;
  EXPECT_THROW(pipeline.ChangeOptions(options), InputError);
}

TEST(HuntPipeline, HeightOfGroundCountsFromItsZero) {
  HuntPipelineOptions options;
  options.ground_height_m = 0.2;
  HuntPipeline pipeline(Calibration(), DefaultObjectModel(), options);
  pipeline.SetGroundZero(-0.5);
  pipeline.AddPose({At(0), {Eigen::Quaterniond::Identity(), {0, 0, kHeight_m - 0.3}}});
  const HuntObservation& seen = pipeline.Process(DrawDiscs({{420, 140}}), At(0));
  ASSERT_TRUE(seen.in_world[0]);
  EXPECT_NEAR(seen.in_world[0]->position.z(), 0.012 - 0.3, 0.01);
}

TEST(HuntPipeline, RefusesInvalidOptions) {
  HuntPipelineOptions options;
  options.readout_s = -1;
  options.map.capacity = 0;
  options.detector.min_pixels = 1;
  EXPECT_THAT(ViolationsOf(options), SizeIs(3));
  EXPECT_THROW(HuntPipeline(Calibration(), DefaultObjectModel(), options), InputError);
}

}  // namespace
}  // namespace kestrel
