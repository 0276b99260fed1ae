// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/landing_pipeline.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/geometry/test_rotation.h"
#include "kestrel/vision/pipeline/calibration_monitor.h"
#include "kestrel/vision/pipeline/input_contradictions.h"
#include "kestrel/vision/pipeline/test_pattern.h"
#include "kestrel/vision/tags/test_tag_images.h"

namespace kestrel {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

// A camera that looks down, slightly tilted, from a UAV above a pattern on the ground.
class LandingPipelineTest : public ::testing::Test {
 protected:
  LandingPipelineTest() {
    calibration_.intrinsics = {640, 480, 400, 400, 319.5, 239.5, DistortionModel::kNone, {}};
    calibration_.body_from_camera = RigidTransform{
        Eigen::Quaterniond((Eigen::Matrix3d() << 0, -1, 0, -1, 0, 0, 0, 0, -1).finished()),
        {0.13, 0.02, -0.05}};
  }

  RigidTransform CameraFromPattern() const {
    const RigidTransform world_from_camera = world_from_body_ * *calibration_.body_from_camera;
    return world_from_camera.Inverse() * world_from_pattern_;
  }
  cv::Mat Draw() const {
    return DrawPattern(CameraModel(calibration_.intrinsics), options_.detector.pattern,
                       CameraFromPattern());
  }
  LandingObservation ProcessWithPose(const LandingPipelineOptions& options) const {
    LandingPipeline pipeline(calibration_, options);
    EXPECT_EQ(pipeline.AddPose({kTime + Duration(5), world_from_body_}), PoseStatus::kOk);
    return pipeline.Process(Draw(), kTime);
  }

  static constexpr Time kTime = TimeFromNanoseconds(1'000'000'000);
  CameraCalibration calibration_;
  LandingPipelineOptions options_;
  RigidTransform world_from_body_ = {
      Rotation(0.4, Eigen::Vector3d::UnitZ()) * Rotation(0.15, {1, 2, 0}), {10, 20, 3.5}};
  RigidTransform world_from_pattern_ = {Rotation(0.3, Eigen::Vector3d::UnitZ()), {10.2, 20.1, 0.5}};
};

TEST_F(LandingPipelineTest, GivesPositionInCameraOnlyWithoutPose) {
  LandingPipeline pipeline(calibration_, options_);
  const LandingObservation observation = pipeline.Process(Draw(), kTime);
  ASSERT_TRUE(observation.report.detection) << observation.report.reason;
  const Eigen::Vector3d center = observation.report.detection->camera_from_target.translation;
  EXPECT_LT((center - CameraFromPattern().translation).norm(), 0.03);
  EXPECT_FALSE(observation.center_in_world);
  EXPECT_FALSE(observation.yaw_in_world);
  EXPECT_GT(observation.detect_time.count(), 0);
}

TEST_F(LandingPipelineTest, ReportsOtherTagOfFamily) {
  SetOption("target.kind=apriltag", &options_);
  SetOption("target.id=8", &options_);
  LandingPipeline pipeline(calibration_, options_);
  const auto image_of = [this](int id) {
    BoardTag tag;
    tag.id = id;
    return TagRenderer(CameraModel(calibration_.intrinsics))
        .Render(TagBoard{{tag}}.Printed(), BoardBelow(2, {0.1, 0}, 0.4, {0.05, 0, 0}), {}, 1);
  };
  const cv::Mat seven = image_of(7);
  EXPECT_EQ(MissInWords(pipeline.Process(seven, kTime)),
            "no tag36h11 8; tag36h11 7 was seen in 1 frame");
  EXPECT_EQ(MissInWords(pipeline.Process(seven, kTime + std::chrono::milliseconds(40))),
            "no tag36h11 8; tag36h11 7 was seen in 2 frames");
  // From the first detection on it is clear which pad is meant.
  EXPECT_TRUE(
      pipeline.Process(image_of(8), kTime + std::chrono::milliseconds(80)).report.detection);
  EXPECT_FALSE(pipeline.Process(seven, kTime + std::chrono::milliseconds(120)).other_tag);
}

TEST_F(LandingPipelineTest, LocatesInWorldBySize) {
  calibration_.clock_offset = Duration(5);
  options_.target_height_m = 0.5;
  const LandingObservation observation = ProcessWithPose(options_);
  ASSERT_TRUE(observation.center_in_world);
  EXPECT_EQ(observation.position_method, PositionMethod::kSize);
  EXPECT_LT((*observation.center_in_world - world_from_pattern_.translation).norm(), 0.03);
  EXPECT_NEAR(*observation.yaw_in_world, 0.3, 0.02);
}

TEST_F(LandingPipelineTest, LocatesInWorldByAltitude) {
  calibration_.clock_offset = Duration(5);
  options_.position_by_altitude = true;
  options_.target_height_m = 0.5;
  const LandingObservation observation = ProcessWithPose(options_);
  ASSERT_TRUE(observation.center_in_world);
  EXPECT_EQ(observation.position_method, PositionMethod::kAltitude);
  EXPECT_NEAR(observation.center_in_world->z(), 0.5, 1e-12);
  EXPECT_LT((*observation.center_in_world - world_from_pattern_.translation).norm(), 0.02);
}

TEST_F(LandingPipelineTest, FallsBackToSizeWithoutUsableAltitude) {
  calibration_.clock_offset = Duration(5);
  options_.position_by_altitude = true;
  options_.target_height_m = 50;  // above the camera
  const LandingObservation observation = ProcessWithPose(options_);
  ASSERT_TRUE(observation.center_in_world);
  EXPECT_EQ(observation.position_method, PositionMethod::kSize);
}

TEST_F(LandingPipelineTest, LooksUpPoseAtNavigationTimeOfFrame) {
  calibration_.clock_offset = Duration(0);
  EXPECT_FALSE(ProcessWithPose(options_).world_from_camera);  // the only pose is 5 ns later
  calibration_.clock_offset = Duration(5);
  EXPECT_TRUE(ProcessWithPose(options_).world_from_camera);
}

TEST_F(LandingPipelineTest, GivesNoWorldPositionWithoutMount) {
  calibration_.body_from_camera.reset();
  calibration_.clock_offset = Duration(5);
  const LandingObservation observation = ProcessWithPose(options_);
  EXPECT_TRUE(observation.report.detection);
  EXPECT_FALSE(observation.center_in_world);
}

TEST_F(LandingPipelineTest, FindsPatternAgainAfterAnyJump) {
  LandingPipeline pipeline(calibration_, options_);
  for (int i = 0; i < 6; ++i) {
    world_from_pattern_.translation.x() = 10.2 + (i % 2 == 0 ? 0.6 : -0.6);
    const auto observation = pipeline.Process(Draw(), kTime + i * Duration(33'000'000));
    ASSERT_TRUE(observation.report.detection) << i;
    const Eigen::Vector3d center = observation.report.detection->camera_from_target.translation;
    EXPECT_LT((center - CameraFromPattern().translation).norm(), 0.04) << i;
  }
}

// The UAV swings, and its poses are stamped 10 ms too late: a pattern 10 m below seems to move to
// and fro by a third of a metre. Who knows how uncertain the stamps are keeps the track.
TEST_F(LandingPipelineTest, UncertainPoseTimesDoNotEndTrack) {
  constexpr Duration kFrame = std::chrono::milliseconds(50);
  constexpr Duration kLate = std::chrono::milliseconds(10);
  const auto body_at = [](Time time) {
    const double swing_rad = 0.35 * std::sin(9 * ToSeconds(time - kTime));
    return RigidTransform{Rotation(swing_rad, Eigen::Vector3d::UnitX()), {10, 20, 10}};
  };
  const auto count_outside = [&](double sigma_s) {
    LandingPipeline pipeline(calibration_, options_);
    int outside = 0;
    for (int i = 0; i < 40; ++i) {
      const Time time = kTime + i * kFrame;
      for (const Duration before : {kFrame / 2, Duration::zero()}) {
        pipeline.AddPose({time - before, body_at(time - before - kLate), std::nullopt, sigma_s});
      }
      world_from_body_ = body_at(time);
      const LandingObservation observation = pipeline.Process(Draw(), time);
      EXPECT_TRUE(observation.report.detection) << i;
      outside += observation.fate == MeasurementFate::kFarFromTrack ? 1 : 0;
    }
    return outside;
  };
  EXPECT_GT(count_outside(0), 5);
  EXPECT_EQ(count_outside(0.01), 0);
}

// The UAV hovers, the pattern moves at 2 m/s; the frames are 0.1 s apart.
TEST_F(LandingPipelineTest, FollowsAndPredictsPattern) {
  LandingPipeline pipeline(calibration_, options_);
  LandingObservation observation;
  for (int i = 0; i < 8; ++i) {
    const Time time = kTime + i * DurationFromSeconds(0.1);
    pipeline.AddPose({time, world_from_body_});
    world_from_pattern_.translation.x() = 9.5 + 0.2 * i;
    observation = pipeline.Process(Draw(), time);
    ASSERT_TRUE(observation.fate) << i;
    EXPECT_EQ(*observation.fate, i == 0 ? MeasurementFate::kStarted : MeasurementFate::kAccepted);
  }
  EXPECT_EQ(observation.track_state, TrackState::kTracking);
  EXPECT_NEAR(observation.target->motion.velocity().x(), 2, 0.2);
  const auto ahead = pipeline.tracker().Predict(observation.time + DurationFromSeconds(0.5));
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(ahead->motion.position().x(), 9.5 + 0.2 * 7 + 1, 0.15);
}

// The pose before the frame's time moves. The pose after it arrives after the frame was processed.
TEST_F(LandingPipelineTest, PredictsLatePoseAndUsesItOnArrival) {
  const BodyMotion motion{{2, 0, 0}, {0, 0, 0}};
  RigidTransform before = world_from_body_;
  before.translation.x() -= 0.04;
  options_.pose_extrapolation_s = 0.05;
  LandingPipeline pipeline(calibration_, options_);
  pipeline.AddPose({kTime - DurationFromSeconds(0.02), before, motion});
  const auto late = pipeline.Process(Draw(), kTime);
  ASSERT_TRUE(late.center_in_world);
  EXPECT_EQ(late.pose, PoseLookup::kPredicted);
  EXPECT_LT((*late.center_in_world - world_from_pattern_.translation).norm(), 0.03);
  EXPECT_GT(late.pose_uncertainty.position_m, 0);
  EXPECT_EQ(pipeline.AddPose({kTime - DurationFromSeconds(0.001), world_from_body_, motion}),
            PoseStatus::kOk);
  EXPECT_EQ(pipeline.Process(Draw(), kTime + DurationFromSeconds(0.06)).pose, PoseLookup::kTooNew);

  LandingPipeline sure(calibration_, options_);
  sure.AddPose({kTime, world_from_body_, motion});
  EXPECT_LT(sure.Process(Draw(), kTime).target->position_sigma_m(),
            late.target->position_sigma_m());
}

// The pattern turns in place at 0.4 rad/s.
TEST_F(LandingPipelineTest, TracksTurnOfPatternUnlessDisabled) {
  for (const bool track_yaw : {true, false}) {
    options_.track_yaw = track_yaw;
    LandingPipeline pipeline(calibration_, options_);
    LandingObservation observation;
    for (int i = 0; i < 8; ++i) {
      const Time time = kTime + i * DurationFromSeconds(0.1);
      pipeline.AddPose({time, world_from_body_});
      world_from_pattern_.rotation = Rotation(0.3 + 0.04 * i, Eigen::Vector3d::UnitZ());
      observation = pipeline.Process(Draw(), time);
    }
    ASSERT_TRUE(observation.target);
    EXPECT_NEAR(observation.target->motion.turn_rate(), track_yaw ? 0.4 : 0, 0.05);
  }
}

TEST_F(LandingPipelineTest, WrongTrackDoesNotHidePattern) {
  LandingPipeline pipeline(calibration_, options_);
  for (int i = 0; i < 10; ++i) {
    const Time time = kTime + i * DurationFromSeconds(0.1);
    pipeline.AddPose({time, world_from_body_});
    if (i == 5) world_from_pattern_.translation.x() += 1;
    const auto observation = pipeline.Process(Draw(), time);
    EXPECT_TRUE(observation.report.detection) << i;
    if (i == 5) {
      EXPECT_EQ(observation.fate, MeasurementFate::kFarFromTrack);
    }
    if (i == 9) {
      EXPECT_EQ(observation.fate, MeasurementFate::kStarted);
    }
  }
}

// A standing pattern in 12 frames, with a given altitude that contradicts the view.
TEST_F(LandingPipelineTest, WrongNavigationAltitudeIsReportedAndHidesNothing) {
  options_.target_height_m = 0.5;
  for (const double excess_m : {0.0, 10.0, 500.0, -10.0}) {
    LandingPipeline pipeline(calibration_, options_);
    for (int i = 0; i < 12; ++i) {
      const Time time = kTime + i * DurationFromSeconds(0.1);
      world_from_body_.translation.x() = 10 + 0.05 * i;
      RigidTransform reported = world_from_body_;
      reported.translation.z() += excess_m;
      pipeline.AddPose({time, reported});
      EXPECT_TRUE(pipeline.Process(Draw(), time).center_in_world) << excess_m << ", frame " << i;
    }
    EXPECT_FALSE(pipeline.contradictions().Attitude());
    const auto contradiction = pipeline.contradictions().Altitude();
    ASSERT_EQ(contradiction.has_value(), excess_m != 0) << excess_m;
    if (excess_m == 0) continue;
    EXPECT_NEAR(contradiction->difference, excess_m, 0.1);
  }
}

TEST_F(LandingPipelineTest, UpsideDownCameraIsReportedAndHidesNothing) {
  CameraCalibration wrong = calibration_;
  wrong.body_from_camera->rotation =
      wrong.body_from_camera->rotation * Rotation(std::numbers::pi, Eigen::Vector3d::UnitX());
  LandingPipeline pipeline(wrong, options_);
  for (int i = 0; i < 12; ++i) {
    const Time time = kTime + i * DurationFromSeconds(0.1);
    world_from_body_.translation.x() = 10 + 0.05 * i;
    pipeline.AddPose({time, world_from_body_});
    EXPECT_TRUE(pipeline.Process(Draw(), time).center_in_world) << i;
  }
  ASSERT_TRUE(pipeline.contradictions().Attitude());
  EXPECT_GT(pipeline.contradictions().Attitude()->difference, 2.5);
}

// With such a mount the pad seems to be in the sky.
TEST_F(LandingPipelineTest, TurnedCameraHidesPadInThreeFramesAtMost) {
  for (const double turn : {1.2, 1.6, 2.0, 2.4}) {
    CameraCalibration wrong = calibration_;
    wrong.body_from_camera->rotation =
        wrong.body_from_camera->rotation * Rotation(turn, Eigen::Vector3d::UnitX());
    LandingPipeline pipeline(wrong, options_);
    for (int i = 0; i < 16; ++i) {
      const Time time = kTime + i * DurationFromSeconds(0.1);
      world_from_body_.translation.x() = 10 + 0.05 * i;
      pipeline.AddPose({time, world_from_body_});
      const bool is_found = pipeline.Process(Draw(), time).report.detection.has_value();
      EXPECT_TRUE(i < 3 || is_found) << turn << ", frame " << i;
    }
  }
}

TEST_F(LandingPipelineTest, ZoomGivesLensOfFrameAtRestOnly) {
  const CameraIntrinsics wide = calibration_.intrinsics;
  calibration_.zoom = ZoomLens{{{ViewOf(wide), wide}}, {}};
  LandingPipeline pipeline(calibration_, options_);
  for (int i = 0; i < 16; ++i) {
    // A report before each image; from the eighth image on another sensor.
    const Time time = kTime + i * DurationFromSeconds(0.1);
    calibration_.intrinsics.fx_px = calibration_.intrinsics.fy_px = i < 8 ? 400 : 600;
    pipeline.AddZoom({time - DurationFromSeconds(0.01), ViewOf(calibration_.intrinsics)});
    pipeline.AddPose({time, world_from_body_});
    const LandingObservation seen = pipeline.Process(Draw(), time);
    EXPECT_EQ(seen.is_zooming, i == 8) << i;
    EXPECT_EQ(seen.center_in_world.has_value(), i != 8) << i;
    if (!seen.center_in_world) continue;
    EXPECT_LT((*seen.center_in_world - world_from_pattern_.translation).norm(), 0.03) << i;
    ASSERT_TRUE(seen.zoomed_lens);
    EXPECT_NEAR(seen.zoomed_lens->intrinsics().fx_px, calibration_.intrinsics.fx_px, 1e-6);
  }
}

TEST_F(LandingPipelineTest, WrongUserAltitudeIsReportedAndHidesNothing) {
  LandingPipeline pipeline(calibration_, options_);
  pipeline.SetAltitude(20);
  world_from_body_.translation.z() = 6.5;
  for (int i = 0; i < 12; ++i) {
    world_from_body_.translation.x() = 10 + 0.05 * i;
    const Time time = kTime + i * DurationFromSeconds(0.1);
    EXPECT_TRUE(pipeline.Process(Draw(), time).report.detection) << i;
  }
  ASSERT_TRUE(pipeline.contradictions().Altitude());
  EXPECT_NEAR(pipeline.contradictions().Altitude()->difference, 14, 0.3);
}

TEST_F(LandingPipelineTest, LocatesByAltitudeForAnyWorldOrigin) {
  options_.position_by_altitude = true;
  LandingPipeline pipeline(calibration_, options_);
  const cv::Mat image = Draw();
  RigidTransform reported = world_from_body_;
  reported.translation.z() += 100;
  LandingObservation observation;
  for (int i = 0; i < 12; ++i) {
    const Time time = kTime + i * DurationFromSeconds(0.1);
    pipeline.AddPose({time, reported});
    observation = pipeline.Process(image, time);
  }
  ASSERT_TRUE(observation.center_in_world);
  EXPECT_EQ(observation.position_method, PositionMethod::kAltitude);
  const Eigen::Vector3d expected = world_from_pattern_.translation + Eigen::Vector3d(0, 0, 100);
  EXPECT_LT((*observation.center_in_world - expected).norm(), 0.1);
}

// Near and tilted views from all sides show that the focal length is wrong. The distance of a far
// view is then uncertain, but its direction is not.
TEST_F(LandingPipelineTest, WrongFocalLengthMakesDistancesUncertain) {
  const CameraModel camera(calibration_.intrinsics);
  calibration_.intrinsics.fx_px = calibration_.intrinsics.fy_px = 1.15 * 400;
  const auto covariance_of_far_one = [&](int near_views) {
    LandingPipeline pipeline(calibration_, options_);
    const auto see = [&](double distance_m, double tilt, int i) {
      const RigidTransform pose = {Rotation(0.2 * i, {0, 0, 1}) * Rotation(tilt, {1, 0, 0}) *
                                       Rotation(std::numbers::pi, {1, 0, 0}) *
                                       Rotation(0.5 * i, {0, 0, 1}),
                                   {0, 0, distance_m}};
      return pipeline.Process(DrawPattern(camera, options_.detector.pattern, pose),
                              kTime + i * DurationFromSeconds(0.1));
    };
    for (int i = 0; i < near_views; ++i) see(2.2, 1, i);
    EXPECT_EQ(pipeline.calibration_monitor().Contradiction().has_value(), near_views > 0);
    const LandingObservation far = see(9, 0, near_views);
    EXPECT_TRUE(far.report.detection);
    return far.report.detection ? far.report.detection->covariance
                                : Eigen::Matrix<double, 6, 6>::Zero().eval();
  };
  const auto before = covariance_of_far_one(0);
  const auto after = covariance_of_far_one(20);
  EXPECT_LT(std::sqrt(before(2, 2)), 0.02 * 9);
  EXPECT_NEAR(std::sqrt(after(2, 2)), 0.13 * 9 * 1.15, 0.4) << "it seems to be 1.35 m farther away";
  EXPECT_LT(std::sqrt(after(0, 0)), 0.02);
}

// A lens of 370 px. The right calibration is never contradicted; a wrong one is, within 30 frames.
TEST_F(LandingPipelineTest, ReportsOtherLensWithinThirtyFrames) {
  constexpr double kFocal_px = 370;
  options_.still = true;
  const auto intrinsics = [](double focal_px, double center_x_px) {
    return CameraIntrinsics{
        640, 360, focal_px, focal_px, center_x_px, 179.5, DistortionModel::kNone, {}};
  };
  const auto pipeline_with = [&](double focal_px, double center_x_px = 319.5) {
    calibration_.intrinsics = intrinsics(focal_px, center_x_px);
    return LandingPipeline(calibration_, options_);
  };
  const CameraModel camera(intrinsics(kFocal_px, 319.5));
  for (const std::uint64_t seed : {1, 2}) {
    LandingPipeline right = pipeline_with(kFocal_px),
                    other_center = pipeline_with(kFocal_px, 359.5);
    std::vector<LandingPipeline> wrong;
    for (const double focal_px : {500.0, 444.0, 296.0}) wrong.push_back(pipeline_with(focal_px));
    Random random(seed);
    for (int i = 0; i < 30; ++i) {
      const cv::Mat image = DrawRandomView(camera, options_.detector.pattern, &random);
      const LandingObservation seen = right.Process(image, kTime);
      ASSERT_TRUE(seen.report.detection) << seed << " " << i;
      EXPECT_LT(seen.report.detection->diagnostics.misfit_px, 0.5) << seed << " " << i;
      EXPECT_FALSE(seen.report.detection->diagnostics.is_misfit()) << seed << " " << i;
      EXPECT_EQ(LensWarning(right.calibration_monitor(), kFocal_px), "") << seed << " " << i;
      other_center.Process(image, kTime);
      EXPECT_FALSE(other_center.calibration_monitor().Contradiction()) << seed << " " << i;
      for (LandingPipeline& pipeline : wrong) pipeline.Process(image, kTime);
    }
    EXPECT_NE(LensWarning(other_center.calibration_monitor(), kFocal_px), "") << seed;
    for (const LandingPipeline& pipeline : wrong) {
      const double given_px = pipeline.detector().camera().intrinsics().fx_px;
      const auto focal = pipeline.calibration_monitor().Contradiction();
      ASSERT_TRUE(focal) << seed << " " << given_px;
      EXPECT_NEAR(focal->factor * given_px, kFocal_px, 3 * focal->sigma * given_px) << seed;
      EXPECT_LT(focal->sigma, 0.07) << seed;
    }
  }
}

// The time limit allows one step per frame.
TEST_F(LandingPipelineTest, SearchOutOfTimeContinuesInNextFrame) {
  constexpr double kOneStep_ms = 1e-6;
  world_from_body_.translation.z() = 12.5;  // small: none of the first steps finds it
  const cv::Mat image = Draw();
  for (const auto& [still, by_options] : {std::pair{true, true}, {false, true}, {false, false}}) {
    options_.still = still;
    options_.detector.max_search_ms = by_options ? kOneStep_ms : 0;
    LandingPipeline pipeline(calibration_, options_);
    if (!by_options) pipeline.LimitSearch(kOneStep_ms);
    bool is_found = false;
    for (int i = 0; i < 48 && !is_found; ++i) {
      is_found = pipeline.Process(image, kTime + i * Duration(1)).report.detection.has_value();
      EXPECT_FALSE(i == 0 && is_found);
    }
    EXPECT_EQ(is_found, !still);
  }
}

TEST_F(LandingPipelineTest, KeepsNoTrackOfStillFrames) {
  options_.still = true;
  calibration_.clock_offset = Duration(5);
  const LandingObservation observation = ProcessWithPose(options_);
  EXPECT_TRUE(observation.center_in_world);
  EXPECT_FALSE(observation.fate);
  EXPECT_FALSE(observation.target);
}

TEST_F(LandingPipelineTest, ReportsImageOfAnotherSizeAsMiss) {
  LandingPipeline pipeline(calibration_, options_);
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(20000, 2), cv::Size(480, 640)}) {
    const auto observation = pipeline.Process(cv::Mat(size, CV_8UC1, 100), kTime);
    EXPECT_FALSE(observation.report.detection);
    EXPECT_FALSE(observation.report.reason.empty());
  }
}

TEST_F(LandingPipelineTest, ChecksOptionsAndCalibration) {
  options_.hint_sigma_m = 0;
  options_.pose_gap_s = std::numeric_limits<double>::quiet_NaN();
  options_.detector.min_quality = 2;
  EXPECT_THAT(ViolationsOf(options_), Contains(HasSubstr("hint_sigma_m")));
  EXPECT_THAT(ViolationsOf(options_), Contains(HasSubstr("pose_gap_s")));
  options_.target.kind = "ring";
  EXPECT_THAT(ViolationsOf(options_), Contains(HasSubstr("detector.min_quality")));
  EXPECT_THAT(ViolationsOf(options_), Contains(HasSubstr("target.kind is 'ring'")));
  EXPECT_THROW(LandingPipeline(calibration_, options_), InputError);
  calibration_.intrinsics.fx_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(LandingPipeline(calibration_, LandingPipelineOptions()), InputError);
}

TEST_F(LandingPipelineTest, OptionsRoundTripThroughText) {
  options_.detector.pattern.outer_diameter_m = 0.6;
  options_.position_by_altitude = true;
  LandingPipelineOptions again;
  ReadOptionFields(PrintOptions(options_), "printed", FieldsOf(again));
  EXPECT_EQ(PrintOptions(again), PrintOptions(options_));
  EXPECT_EQ(again.detector.pattern.outer_diameter_m, 0.6);
}

TEST_F(LandingPipelineTest, ChangedOptionsKeepTrack) {
  LandingPipeline pipeline(calibration_, options_);
  Time time = kTime;
  for (int i = 0; i < 8; ++i) {
    time += std::chrono::milliseconds(100);
    pipeline.AddPose({time + Duration(5), world_from_body_});
    EXPECT_TRUE(pipeline.Process(Draw(), time).report.detection);
  }
  options_.detector.min_quality = 1;
  pipeline.ChangeOptions(options_);
  time += std::chrono::milliseconds(100);
  pipeline.AddPose({time + Duration(5), world_from_body_});
  const LandingObservation observation = pipeline.Process(Draw(), time);
  EXPECT_FALSE(observation.report.detection);
  ASSERT_TRUE(observation.target);
  EXPECT_LT((observation.target->motion.position() - world_from_pattern_.translation).norm(), 0.1);
  options_.detector.min_quality = 2;
  EXPECT_THROW(pipeline.ChangeOptions(options_), InputError);
}

// Finds a pad in every image, at a given place, and remembers the hint.
class FakeDetector : public TargetDetector {
 public:
  FakeDetector(const CameraModel& camera, const RigidTransform& camera_from_target, int symmetry,
               TargetHint* hint)
      : camera_(camera), hint_(hint) {
    detection_.camera_from_target = camera_from_target;
    detection_.covariance = 1e-4 * Eigen::Matrix<double, 6, 6>::Identity();
    detection_.heading_symmetry = symmetry;
    detection_.id = 7;
  }

  TargetReport Detect(const cv::Mat& /*image*/, const TargetHint& hint,
                      TargetWorkspace& /*workspace*/) const override {
    *hint_ = hint;
    TargetReport report;
    report.detection = detection_;
    return report;
  }
  std::unique_ptr<TargetWorkspace> MakeWorkspace() const override {
    return std::make_unique<TargetWorkspace>();
  }
  const CameraModel& camera() const override { return camera_; }
  const TargetShape& shape() const override { return shape_; }

 private:
  CameraModel camera_;
  TargetShape shape_;
  TargetDetection detection_{};
  TargetHint* hint_;
};

class OwnDetectorTest : public LandingPipelineTest {
 protected:
  LandingPipeline PipelineOf(int symmetry) {
    return {calibration_,
            std::make_unique<FakeDetector>(CameraModel(calibration_.intrinsics),
                                           CameraFromPattern(), symmetry, &hint_),
            options_};
  }
  // Eight frames, with poses or without.
  LandingObservation Fly(LandingPipeline* pipeline, bool has_poses = true) const {
    LandingObservation last;
    for (int i = 0; i < 8; ++i) {
      const Time time = kTime + std::chrono::milliseconds(100 * i);
      if (has_poses) pipeline->AddPose({time, world_from_body_});
      last = pipeline->Process(cv::Mat(), time);
    }
    return last;
  }

  static constexpr double kYaw = 2.5;
  TargetHint hint_;
};

TEST_F(OwnDetectorTest, HeadingIsKnownAndReturnsAsHint) {
  world_from_pattern_.rotation = Rotation(kYaw, Eigen::Vector3d::UnitZ());
  LandingPipeline pipeline = PipelineOf(/*symmetry=*/1);
  const LandingObservation seen = Fly(&pipeline);
  ASSERT_TRUE(seen.yaw_in_world);
  EXPECT_NEAR(*seen.yaw_in_world, kYaw, 1e-6);
  ASSERT_TRUE(seen.target);
  EXPECT_TRUE(seen.target->has_yaw());
  EXPECT_NEAR(std::remainder(seen.target->motion.yaw() - kYaw, kFullTurn), 0, 0.02);
  ASSERT_TRUE(hint_.rotation_in_camera);
  EXPECT_LT(hint_.rotation_in_camera->angularDistance(CameraFromPattern().rotation), 0.02);
  EXPECT_EQ(hint_.id, 7);
}

TEST_F(OwnDetectorTest, UsesLastOrientationAsHintWithoutPoses) {
  LandingPipeline pipeline = PipelineOf(/*symmetry=*/1);
  EXPECT_FALSE(Fly(&pipeline, /*has_poses=*/false).yaw_in_world);
  ASSERT_TRUE(hint_.rotation_in_camera);
  EXPECT_LT(hint_.rotation_in_camera->angularDistance(CameraFromPattern().rotation), 1e-9);
  EXPECT_EQ(hint_.id, 7);
}

TEST_F(OwnDetectorTest, HeadingIsKnownUpToSymmetryOfPad) {
  world_from_pattern_.rotation = Rotation(kYaw, Eigen::Vector3d::UnitZ());
  LandingPipeline pipeline = PipelineOf(/*symmetry=*/2);
  const LandingObservation seen = Fly(&pipeline);
  ASSERT_TRUE(seen.yaw_in_world);
  EXPECT_NEAR(*seen.yaw_in_world, kYaw - std::numbers::pi, 1e-6);
  EXPECT_FALSE(seen.target->has_yaw());
  // The pad is followed in the orientation in which it was seen.
  ASSERT_TRUE(hint_.rotation_in_camera);
  EXPECT_LT(hint_.rotation_in_camera->angularDistance(CameraFromPattern().rotation), 0.02);
}

TEST_F(OwnDetectorTest, DiscHasNoYaw) {
  LandingPipeline pipeline = PipelineOf(/*symmetry=*/0);
  const LandingObservation seen = Fly(&pipeline);
  EXPECT_FALSE(seen.yaw_in_world);
  ASSERT_TRUE(seen.target);
  EXPECT_FALSE(seen.target->has_yaw());
}

TEST_F(OwnDetectorTest, ChangedOptionsKeepDetector) {
  LandingPipeline pipeline = PipelineOf(/*symmetry=*/1);
  const TargetDetector* const own = &pipeline.detector();
  options_.detector.min_quality = 1;
  pipeline.ChangeOptions(options_);
  EXPECT_EQ(&pipeline.detector(), own);
  EXPECT_TRUE(Fly(&pipeline).report.detection);
}

}  // namespace
}  // namespace kestrel
