// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/euroc/euroc_text.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"

namespace kestrel {
namespace {

TEST(EurocTextTest, CalibrationRoundTrips) {
  CameraCalibration written;
  written.intrinsics = {.width_px = 752,
                        .height_px = 480,
                        .fx_px = 261.1,
                        .fy_px = 1.0 / 3,
                        .cx_px = 376.25,
                        .cy_px = 240,
                        .distortion_model = DistortionModel::kEquidistant,
                        .distortion = {-0.0448, 0.0686053, -0.072277, 0.027011955}};
  written.intrinsics.fy_px = 260.0 + 1.0 / 3;
  written.body_from_camera = {
      Eigen::Quaterniond(Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized())),
      {0.1, -0.2, 0.3}};
  const CameraCalibration read = ParseCalibration(EurocCameraText(written, 30), "sensor.yaml");
  EXPECT_EQ(read.intrinsics.fy_px, written.intrinsics.fy_px);
  EXPECT_EQ(read.intrinsics.width_px, 752);
  EXPECT_EQ(read.intrinsics.distortion, written.intrinsics.distortion);
  EXPECT_EQ(read.intrinsics.distortion_model, DistortionModel::kEquidistant);
  ASSERT_TRUE(read.body_from_camera);
  EXPECT_LT(read.body_from_camera->rotation.angularDistance(written.body_from_camera->rotation),
            1e-12);
  EXPECT_EQ(read.body_from_camera->translation, written.body_from_camera->translation);
}

TEST(EurocTextTest, GimbalRoundTrip) {
  CameraCalibration written;
  written.intrinsics.width_px = 640;
  written.intrinsics.height_px = 480;
  written.intrinsics.fx_px = written.intrinsics.fy_px = 500;
  written.intrinsics.cx_px = 320;
  written.intrinsics.cy_px = 240;
  GimbalMount gimbal;
  gimbal.body_from_pivot.translation = {0.2, 0, -0.1};
  gimbal.platform_from_camera.rotation = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);
  gimbal.clock_offset = std::chrono::milliseconds(-150);
  gimbal.device_id = 1;
  written.gimbal = gimbal;
  const CameraCalibration read = ParseCalibration(EurocCalibrationText(written, 30), "lens.yaml");
  ASSERT_TRUE(read.gimbal);
  EXPECT_EQ(read.gimbal->body_from_pivot.translation, gimbal.body_from_pivot.translation);
  EXPECT_LT(read.gimbal->platform_from_camera.rotation.angularDistance(
                gimbal.platform_from_camera.rotation),
            1e-12);
  EXPECT_EQ(read.gimbal->clock_offset, gimbal.clock_offset);
  EXPECT_EQ(read.gimbal->device_id, 1);

  const GimbalSample sample{TimeFromNanoseconds(7), Eigen::Quaterniond(0.6, 0, 0.8, 0),
                            YawFrame::kVehicle};
  const auto rows = ParseGimbalRows(EurocGimbalColumns() + "\n" + EurocGimbalCells(sample) + "\n",
                                    "data.csv", YawFrame::kVehicle);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].time, sample.time);
  EXPECT_NEAR(rows[0].level_from_platform.y(), 0.8, 1e-9);
  EXPECT_EQ(rows[0].yaw_frame, YawFrame::kVehicle);
}

TEST(EurocTextTest, ZoomRoundTrip) {
  CameraCalibration written;
  written.intrinsics = {
      640, 480, 560, 560, 320, 240, DistortionModel::kRadialTangential, {-0.1, 0, 0, 0}};
  CameraIntrinsics narrow = written.intrinsics;
  narrow.fx_px = narrow.fy_px = 1800.25;
  narrow.distortion[0] = 0.1;
  written.zoom =
      ZoomLens{{{0.375, narrow}, {1.05, written.intrinsics}}, std::chrono::milliseconds(-150), 2};
  const CameraCalibration read = ParseCalibration(EurocCalibrationText(written, 30), "lens.yaml");
  ASSERT_TRUE(read.zoom);
  EXPECT_EQ(read.zoom->clock_offset, written.zoom->clock_offset);
  EXPECT_EQ(read.zoom->device_id, 2);
  ASSERT_EQ(read.zoom->settings.size(), 2u);
  EXPECT_NEAR(read.zoom->settings[0].view_rad, 0.375, 1e-12);
  EXPECT_EQ(read.zoom->settings[0].lens.fx_px, 1800.25);
  EXPECT_EQ(read.zoom->settings[0].lens.distortion[0], 0.1);

  const auto rows =
      ParseZoomRows(EurocZoomText({{TimeFromNanoseconds(7), 0.375}}), "zoom0/data.csv");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].time, TimeFromNanoseconds(7));
  EXPECT_NEAR(rows[0].view_rad, 0.375, 1e-6);
}

TEST(EurocTextTest, PosesRoundTrip) {
  const std::vector<PoseSample> written = {
      {TimeFromNanoseconds(5), {Eigen::Quaterniond(0.6, 0, 0.8, 0), {1, -2, 3.5}}},
      {TimeFromNanoseconds(9), {Eigen::Quaterniond(0, 0, 0, 1), {0, 0, -1}}}};
  const auto read = ParsePoseRows(EurocPoseText(written), "data.csv");
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].time, written[0].time);
  EXPECT_EQ(read[0].world_from_body.translation, written[0].world_from_body.translation);
  EXPECT_NEAR(read[1].world_from_body.rotation.z(), 1, 1e-9);
}

}  // namespace
}  // namespace kestrel
