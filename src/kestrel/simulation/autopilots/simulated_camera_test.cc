// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/simulated_camera.h"

#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/poses/gimbal_angles.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;
using std::chrono_literals::operator""ms;

constexpr Time kStart = TimeFromNanoseconds(7'000'000'000);

// A UAV that flies past the vehicle, turning and tilted.
PoseSample PoseOver(const Vector3d& start, Time time) {
  const double time_s = ToSeconds(time - kStart);
  PoseSample pose;
  pose.time = time;
  pose.world_from_body.translation = start + time_s * Vector3d(0.8, -0.5, 0.2);
  const Eigen::Quaterniond tilt = RotationBy({0.1, -0.06, 0});
  const Vector3d rate_in_world(0, 0, 0.6);
  pose.world_from_body.rotation = RotationBy(time_s * rate_in_world) * tilt;
  pose.motion = BodyMotion{{0.8, -0.5, 0.2}, tilt.conjugate() * rate_in_world};
  return pose;
}

class SimulatedCameraTest : public testing::Test {
 protected:
  SimulatedCameraTest() : world_(ReadVehicleWorld("circle", {}), kStart, /*seed=*/3) {}

  // Adds poses from 'begin_s' to 'end_s', 'altitude_m' above the pattern's place at the start.
  void Fly(SimulatedCamera* camera, double altitude_m, double begin_s, double end_s) {
    const Vector3d start = world_.PatternAt(kStart).translation + Vector3d(-0.2, 0.3, altitude_m);
    for (double time_s = begin_s; time_s < end_s; time_s += 0.02) {
      camera->AddPose(PoseOver(start, kStart + DurationFromSeconds(time_s)));
    }
  }

  VehicleWorld world_;
};

// Returns the pixel of the pattern's centre, by the calibration and the reported poses.
Eigen::Vector2d TruePixel(const SimulatedCamera& camera, const PoseSample& pose, Time stamp) {
  const RigidTransform world_from_camera =
      pose.world_from_body * *camera.calibration().body_from_camera;
  Eigen::Vector2d pixel;
  const CameraModel model(camera.calibration().intrinsics);
  EXPECT_EQ(
      model.Project(world_from_camera.Inverse() * camera.PatternAt(stamp).translation, &pixel),
      ProjectionStatus::kOk);
  return pixel;
}

TEST_F(SimulatedCameraTest, ShowsPatternAtItsPlace) {
  for (const double altitude_m : {1.5, 3.0, 6.0}) {
    SimulatedCamera camera({}, &world_, kStart, /*seed=*/5);
    const LandingPatternDetector detector(CameraModel(camera.calibration().intrinsics), {});
    LandingWorkspace workspace;
    Fly(&camera, altitude_m, 0, 0.5);
    const Time capture = kStart + 250ms;
    const auto frame = camera.Capture(capture);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->time, capture);
    const TargetReport report = detector.Detect(frame->image, {}, workspace);
    ASSERT_TRUE(report.detection) << altitude_m << " m: " << report.reason;
    const Vector3d start = world_.PatternAt(kStart).translation + Vector3d(-0.2, 0.3, altitude_m);
    const Eigen::Vector2d expected = TruePixel(camera, PoseOver(start, capture), frame->time);
    EXPECT_LT((report.detection->center_px - expected).norm(), 1) << altitude_m << " m";
  }
}

TEST_F(SimulatedCameraTest, ExtrapolatesPoseByMotion) {
  SimulatedCamera camera({}, &world_, kStart, /*seed=*/5);
  SimulatedCamera informed({}, &world_, kStart, /*seed=*/5);
  Fly(&camera, 3, 0, 0.2);
  Fly(&informed, 3, 0, 0.5);
  const auto late = camera.Capture(kStart + 300ms);
  const auto in_time = informed.Capture(kStart + 300ms);
  ASSERT_TRUE(late && in_time);
  const LandingPatternDetector detector(CameraModel(camera.calibration().intrinsics), {});
  LandingWorkspace workspace;
  const auto a = detector.Detect(late->image, {}, workspace).detection;
  const auto b = detector.Detect(in_time->image, {}, workspace).detection;
  ASSERT_TRUE(a && b);
  EXPECT_LT((a->center_px - b->center_px).norm(), 0.5);
  EXPECT_FALSE(camera.Capture(kStart + 2000ms)) << "the poses have ended";
}

TEST_F(SimulatedCameraTest, StampsImagesLateByOption) {
  SimulatedCameraOptions options;
  options.clock_offset_s = -0.08;
  SimulatedCamera camera(options, &world_, kStart, /*seed=*/5);
  Fly(&camera, 3, 0, 0.5);
  const auto frame = camera.Capture(kStart + 200ms);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->time, kStart + 280ms);
  EXPECT_EQ(camera.PatternAt(frame->time).translation,
            world_.PatternAt(kStart + 200ms).translation);
  const auto truth = camera.Truth(*frame);
  ASSERT_TRUE(truth);
  EXPECT_EQ(ToNanoseconds(truth->time), 7280000000);
}

TEST_F(SimulatedCameraTest, DeliversLiveFramesInTimeWithMatchingPoses) {
  const Time start = Now();
  VehicleWorld world(ReadVehicleWorld("standing", {}), start, 3);
  SimulatedCamera camera({}, &world, start + 100ms, 5);
  Frame frame;
  EXPECT_FALSE(camera.Next(&frame, 120ms)) << "no pose has come";
  PoseSample pose;
  pose.world_from_body.translation = {0, 0, 4};
  pose.motion = BodyMotion();
  pose.time = Now() - 20ms;
  camera.AddPose(pose);
  pose.time = Now() + 400ms;
  camera.AddPose(pose);
  ASSERT_TRUE(camera.Next(&frame, 2000ms));
  EXPECT_LE(frame.time, Now());
  const Time first = frame.time;
  ASSERT_TRUE(camera.Next(&frame, 2000ms));
  EXPECT_GE(frame.time, first + 50ms);
  EXPECT_EQ((frame.time - start - 100ms) % Duration(50ms), Duration(0));
}

TEST_F(SimulatedCameraTest, UsesTruePosesWhenReportedOnesAreWrong) {
  SimulatedCamera informed({}, &world_, kStart, /*seed=*/5);
  VehicleWorld other(ReadVehicleWorld("circle", {}), kStart, /*seed=*/3);
  SimulatedCamera reported({}, &other, kStart, /*seed=*/5);
  const Vector3d start = world_.PatternAt(kStart).translation + Vector3d(-0.2, 0.3, 3);
  for (int i = 0; i < 25; ++i) {
    const PoseSample pose = PoseOver(start, kStart + i * 20ms);
    world_.ReportPose(pose);
    reported.AddPose(pose);
    informed.AddPose(PoseOver(start + Vector3d(5, 0, 0), kStart + (i - 10) * 20ms));
  }
  const auto by_truth = informed.Capture(kStart + 300ms);
  const auto by_report = reported.Capture(kStart + 300ms);
  ASSERT_TRUE(by_truth && by_report);
  EXPECT_EQ(cv::countNonZero(by_truth->image != by_report->image), 0);
}

// A gimbal that looks down over the UAV's nose, while the UAV turns and tilts.
TEST_F(SimulatedCameraTest, LooksWhereGimbalDoes) {
  GimbalMount gimbal;
  gimbal.body_from_pivot.translation = {0.1, 0, -0.05};
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  gimbal.platform_from_camera.rotation = Eigen::Quaterniond(axes);
  SimulatedCamera camera({}, &world_, kStart, /*seed=*/5, gimbal);
  const Vector3d start = world_.PatternAt(kStart).translation + Vector3d(-2, 0.3, 3);
  const auto attitude = [](double time_s) { return GimbalAngles{0.3 * time_s, 0.9}.rotation(); };
  for (int i = 0; i < 25; ++i) {
    const PoseSample pose = PoseOver(start, kStart + i * 20ms);
    world_.ReportPose(pose, attitude(0.02 * i));
  }
  const Time capture = kStart + 310ms;
  const auto frame = camera.Capture(capture);
  ASSERT_TRUE(frame);
  const LandingPatternDetector detector(CameraModel(camera.calibration().intrinsics), {});
  LandingWorkspace workspace;
  const auto detection = detector.Detect(frame->image, {}, workspace).detection;
  ASSERT_TRUE(detection);
  const RigidTransform world_from_camera =
      WorldFromPlatform(PoseOver(start, capture).world_from_body, gimbal.body_from_pivot,
                        {attitude(0.31), YawFrame::kEarth}) *
      gimbal.platform_from_camera;
  Eigen::Vector2d pixel;
  const CameraModel model(camera.calibration().intrinsics);
  model.Project(world_from_camera.Inverse() * camera.PatternAt(capture).translation, &pixel);
  EXPECT_LT((detection->center_px - pixel).norm(), 1);
}

TEST(VehicleWorldTest, VehicleMayWaitForUav) {
  VehicleWorldOptions options =
      ReadVehicleWorld("straight", {"drive_altitude_m=5", "drive_delay_s=2", "ground.map_px=64"});
  VehicleWorld world(options, kStart, 3);
  const auto place = [&](double time_s) {
    return Vector3d(world.PatternAt(kStart + DurationFromSeconds(time_s)).translation);
  };
  world.ObserveUav(kStart + 5000ms, {3, 0, 4.9});
  EXPECT_EQ(place(100), place(0));
  world.ObserveUav(kStart + 10000ms, {3, 0, 5.1});
  world.ObserveUav(kStart + 11000ms, {3, 0, 9});
  EXPECT_LT((place(12) - place(0)).norm(), 1e-6);
  EXPECT_NEAR((place(22) - place(20)).norm(), 4, 0.05) << "2 m/s";
}

TEST(VehicleWorldTest, ReportsUnknownScenarios) {
  try {
    ReadVehicleWorld("figure9", {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "there is no scenario 'sim:figure9', expected standing, straight, circle, follow, "
                 "hunt, indoor, figure8, road, lanes, motorway, ship, stops");
  }
}

TEST(VehicleWorldOptions, VehicleCarriesPadOfDetectorUnlessSetOtherwise) {
  TargetOptions target;
  target.kind = "apriltag";
  target.apriltag.id = 7;
  const VehicleWorldOptions own = ReadVehicleWorld("standing", {}, target);
  EXPECT_EQ(own.target.kind, "apriltag");
  EXPECT_EQ(own.target.apriltag.id, 7);
  const VehicleWorldOptions other = ReadVehicleWorld("standing", {"target.apriltag.id=8"}, target);
  EXPECT_EQ(other.target.apriltag.id, 8);
}

TEST_F(SimulatedCameraTest, InjectsFaultForAWhile) {
  const auto image_at = [&](const std::string& fault, Duration after_start) {
    SimulatedCameraOptions options;
    options.scale = 0.2;
    options.fault.kind = fault;
    options.fault.after_s = 0.5;
    options.fault.for_s = 0.5;
    SimulatedCamera camera(options, &world_, kStart, /*seed=*/3);
    Fly(&camera, 6, 0, 2);
    camera.Capture(kStart + 400ms);
    return camera.Capture(kStart + after_start)->image;
  };
  const auto differs = [](const cv::Mat& a, const cv::Mat& b) {
    return cv::countNonZero(a != b) > 0;
  };
  const cv::Mat before = image_at("none", 400ms);
  const cv::Mat during = image_at("none", 700ms);
  EXPECT_FALSE(differs(image_at("frozen", 700ms), before));
  EXPECT_FALSE(differs(image_at("frozen", 1200ms), image_at("none", 1200ms)));
  EXPECT_EQ(cv::countNonZero(image_at("black", 700ms)), 0);
  EXPECT_GT(cv::mean(image_at("bright", 700ms))[0], 150);
  EXPECT_TRUE(differs(image_at("beside", 700ms), during));
}

TEST_F(SimulatedCameraTest, DeliversFewerImagesWhenSlow) {
  const auto count = [&](const std::string& fault) {
    const Time start = Now();
    SimulatedCameraOptions options;
    options.scale = 0.1;
    options.fault.kind = fault;
    options.fault.after_s = 0;
    options.fault.for_s = 10;
    VehicleWorld world(ReadVehicleWorld("standing", {}), start, 3);
    SimulatedCamera camera(options, &world, start, /*seed=*/3);
    PoseSample pose = PoseOver(Vector3d(0, 0, 6), kStart);
    for (int i = 0; i < 100; ++i) {
      pose.time = start + i * 20ms;
      camera.AddPose(pose);
    }
    int images = 0;
    Frame frame;
    for (const Time end = Now() + 1000ms; Now() < end;) images += camera.Next(&frame, 50ms) ? 1 : 0;
    return images;
  };
  EXPECT_LE(count("slow"), 6);
  EXPECT_EQ(count("stopped"), 0);
}

TEST(SimulatedCameraOptionsTest, ReportsUnknownFault) {
  SimulatedCameraOptions options;
  options.fault.kind = "foggy";
  EXPECT_THAT(ViolationsOf(options),
              testing::ElementsAre("fault.kind is 'foggy', expected none, frozen, black, bright, "
                                   "slow, stopped, beside, late or turned"));
}

}  // namespace
}  // namespace kestrel
