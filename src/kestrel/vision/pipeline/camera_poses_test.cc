// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/camera_poses.h"

#include <chrono>

#include <gtest/gtest.h>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;
using std::chrono::milliseconds;

constexpr double kHeading = 0.8;
constexpr double kPitch = 1.1;  // below the horizon
constexpr Duration kGimbalOffset = milliseconds(-50);

Time AtMs(int ms) { return Time(milliseconds(ms)); }

Eigen::Quaterniond Turned(double angle, const Vector3d& axis) { return RotationBy(angle * axis); }

// A camera whose optical axis is the platform's x axis, on a gimbal 0.2 m ahead of the body.
CameraCalibration OnGimbal() {
  GimbalMount gimbal;
  gimbal.body_from_pivot.translation = {0.2, 0, 0};
  gimbal.platform_from_camera.rotation = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);
  gimbal.clock_offset = kGimbalOffset;
  CameraCalibration calibration;
  calibration.body_from_camera = gimbal.body_from_pivot * gimbal.platform_from_camera;
  calibration.gimbal = gimbal;
  return calibration;
}

// Poses of a UAV that leans, at 10 m, for 2 s.
CameraPoses Poses(const CameraCalibration& calibration) {
  CameraPoses poses(calibration, 256, milliseconds(200), Duration::zero(), Duration::zero());
  for (int ms = 0; ms <= 2000; ms += 20) {
    poses.Add(PoseSample{
        AtMs(ms),
        {Turned(kHeading, Vector3d::UnitZ()) * Turned(0.2, Vector3d::UnitX()), {0, 0, 10}}});
  }
  return poses;
}

void AddReports(YawFrame frame, CameraPoses* poses) {
  const double yaw = frame == YawFrame::kEarth ? kHeading : 0;
  for (int ms = 0; ms <= 1000; ms += 100) {
    poses->Add(GimbalSample{AtMs(ms) - kGimbalOffset,
                            Turned(yaw, Vector3d::UnitZ()) * Turned(kPitch, Vector3d::UnitY()),
                            frame});
  }
}

TEST(CameraPosesTest, GimbalKeepsOpticalAxisWhileBodyLeans) {
  for (const YawFrame frame : {YawFrame::kEarth, YawFrame::kVehicle}) {
    CameraPoses poses = Poses(OnGimbal());
    AddReports(frame, &poses);
    const auto pose = poses.At(AtMs(510));
    ASSERT_TRUE(pose);
    const Vector3d axis = pose->world_from_camera.rotation * Vector3d::UnitZ();
    const Vector3d expected(std::cos(kHeading) * std::cos(kPitch),
                            std::sin(kHeading) * std::cos(kPitch), -std::sin(kPitch));
    EXPECT_LT((axis - expected).norm(), 1e-9) << ToString(frame);
    const RigidTransform world_from_body = pose->world_from_camera * pose->camera_from_body;
    EXPECT_LT((world_from_body.translation - Vector3d(0, 0, 10)).norm(), 1e-9);
    EXPECT_EQ(poses.Check(AtMs(510)), PoseLookup::kFound);
  }
}

TEST(CameraPosesTest, UncertaintyGrowsAfterNewestReport) {
  CameraPoses poses = Poses(OnGimbal());
  AddReports(YawFrame::kVehicle, &poses);
  const auto between = poses.At(AtMs(950)), after = poses.At(AtMs(1200));
  ASSERT_TRUE(between && after);
  EXPECT_LT(between->uncertainty.attitude_rad, 0.002);
  EXPECT_GT(after->uncertainty.attitude_rad, 0.02);
}

TEST(CameraPosesTest, ReportsSilentGimbal) {
  CameraPoses poses = Poses(OnGimbal());
  EXPECT_FALSE(poses.At(AtMs(500)));
  EXPECT_EQ(poses.Check(AtMs(500)), PoseLookup::kNoGimbal);
  AddReports(YawFrame::kVehicle, &poses);
  EXPECT_TRUE(poses.At(AtMs(500)));
  EXPECT_FALSE(poses.At(AtMs(1500)));
  EXPECT_EQ(poses.Check(AtMs(1500)), PoseLookup::kNoGimbal);
}

}  // namespace
}  // namespace kestrel
