// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/calibration_mount.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/load_yaml.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// A camera that looks down, 0.1 m before the middle of the body and 0.05 m below it.
constexpr const char* kBodyFromCamera =
    "[[0, -1, 0, 0.1], [-1, 0, 0, 0], [0, 0, -1, -0.05], [0, 0, 0, 1]]";
constexpr const char* kCameraFromBody =
    "[[0, -1, 0, 0], [-1, 0, 0, 0.1], [0, 0, -1, -0.05], [0, 0, 0, 1]]";

CameraCalibration Read(const std::string& yaml) {
  CameraCalibration calibration;
  ReadMountAndClock(CalibrationEntry(LoadYaml(yaml, "lens.yaml"), "lens.yaml"), &calibration);
  return calibration;
}

void ExpectMount(const std::string& yaml) {
  const CameraCalibration read = Read(yaml);
  ASSERT_TRUE(read.body_from_camera) << yaml;
  EXPECT_TRUE((*read.body_from_camera * Eigen::Vector3d(0, -1, 2))
                  .isApprox(Eigen::Vector3d(1.1, 0, -2.05), 1e-9))
      << yaml;
}

TEST(CalibrationMount, ReadsEveryNameOfMount) {
  for (const char* name : {"T_BS", "T_imu_cam", "T_BC", "T_B_C", "T_SC", "T_ic", "T_i_c",
                           "body_T_cam0", "Tbc", "IMU.T_b_c1", "imu_T_cam", "T_body_camera"}) {
    ExpectMount(fmt::format("{}: {}\n", name, kBodyFromCamera));
  }
  for (const char* name : {"T_cam_imu", "T_CB", "T_C_B", "T_ci", "T_cam0_imu0", "cam_T_body", "Tcb",
                           "T_SB", "T_cam_body"}) {
    ExpectMount(fmt::format("{}: {}\n", name, kCameraFromBody));
  }
}

// A camera of another number, another camera, another sensor.
TEST(CalibrationMount, IgnoresOtherTransforms) {
  for (const char* name : {"body_T_cam1", "T_cn_cnm1", "T_imu_body", "T_BX", "T_WB"}) {
    EXPECT_FALSE(Read(fmt::format("{}: {}\n", name, kBodyFromCamera)).body_from_camera) << name;
  }
}

constexpr const char* kPivot = "[[1, 0, 0, 0.2], [0, 1, 0, 0], [0, 0, 1, -0.1], [0, 0, 0, 1]]";
constexpr const char* kOnPlatform = "[[0, 0, 1, 0.03], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]]";

TEST(CalibrationMount, ReadsCameraOnGimbal) {
  const CameraCalibration read = Read(fmt::format(
      "T_GS: {}\ngimbal: {{T_BG: {}, time_offset_s: -0.12, device_id: 2}}\n", kOnPlatform, kPivot));
  ASSERT_TRUE(read.gimbal);
  EXPECT_EQ(read.gimbal->clock_offset, DurationFromSeconds(-0.12));
  EXPECT_EQ(read.gimbal->device_id, 2);
  EXPECT_TRUE(read.gimbal->body_from_pivot.translation.isApprox(Eigen::Vector3d(0.2, 0, -0.1)));
  // Level, the optical axis looks ahead.
  ASSERT_TRUE(read.body_from_camera);
  EXPECT_TRUE((*read.body_from_camera * Eigen::Vector3d(0, 0, 1))
                  .isApprox(Eigen::Vector3d(1.23, 0, -0.1), 1e-9));
}

TEST(CalibrationMount, ReadsGimbalFromItsFolder) {
  const TestFolder folder;
  folder.Write("mav0/gimbal0/sensor.yaml",
               fmt::format("sensor_type: gimbal\nT_BG: {}\nyaw_frame: vehicle\n", kPivot));
  const std::string file = folder / "mav0/cam0/sensor.yaml";
  CameraCalibration calibration;
  const std::string text = fmt::format("T_GS: {}\ngimbal: gimbal0\n", kOnPlatform);
  ReadMountAndClock(CalibrationEntry(LoadYaml(text, file), file), &calibration);
  ASSERT_TRUE(calibration.gimbal);
  EXPECT_EQ(calibration.gimbal->body_from_pivot.translation.x(), 0.2);
}

TEST(CalibrationMount, RefusesIncompleteGimbals) {
  const auto error_of = [](const std::string& yaml) { return InputErrorOf([&] { Read(yaml); }); };
  EXPECT_THAT(error_of(fmt::format("T_GS: {}\n", kOnPlatform)),
              HasSubstr("lens.yaml:1: 'T_GS' is on a gimbal, expected a key 'gimbal'"));
  EXPECT_THAT(error_of("gimbal: gimbal0\n"), HasSubstr("'gimbal' has a camera without 'T_GS'"));
  EXPECT_THAT(error_of(fmt::format("T_GS: {}\ngimbal: ../../etc\n", kOnPlatform)),
              HasSubstr("expected the name of a folder"));
  EXPECT_THAT(error_of(fmt::format("T_GS: {}\ngimbal: {{device_id: 1}}\n", kOnPlatform)),
              HasSubstr("'gimbal' has no key 'T_BG'"));
  EXPECT_THAT(error_of(fmt::format("T_BS: {0}\nT_GS: {0}\ngimbal: {{T_BG: {0}}}\n", kPivot)),
              HasSubstr("stands beside a mount on the body"));
  EXPECT_THAT(error_of(fmt::format("T_GS: {0}\ngimbal: {{T_BG: {0}, device_id: 300}}\n", kPivot)),
              HasSubstr("is 300, expected 0 to 255"));
}

// 'keys' beside a pinhole of 640x480 px with k1, k2, p1, p2.
CameraCalibration ReadZoom(const std::string& keys) {
  return ParseCalibration(
      "resolution: [640, 480]\nintrinsics: [560, 560, 320, 240]\n"
      "distortion_model: radtan\ndistortion_coefficients: [0, 0, 0, 0]\n" +
          keys,
      "lens.yaml");
}

TEST(CalibrationMount, ReadsTableOfZoom) {
  const CameraCalibration read = ReadZoom(
      "zoom:\n  time_offset_s: -0.1\n  device_id: 100\n  settings:\n"
      "  - [60, 560, 561, 320, 240, -0.1, 0, 0, 0]\n"
      "  - [20, 1800, 1801, 321, 241, 0.1, 0, 0, 0]\n");
  ASSERT_TRUE(read.zoom);
  EXPECT_EQ(read.zoom->clock_offset, DurationFromSeconds(-0.1));
  EXPECT_EQ(read.zoom->device_id, 100);
  ASSERT_EQ(read.zoom->settings.size(), 2u);
  EXPECT_NEAR(read.zoom->settings[0].view_rad, Radians(20), 1e-9);
  EXPECT_EQ(read.zoom->settings[0].lens.fy_px, 1801);
  EXPECT_EQ(read.zoom->settings[1].lens.distortion[0], -0.1);
  EXPECT_EQ(read.zoom->settings[1].lens.width_px, 640);
}

TEST(CalibrationMount, ZoomWithoutTableHasOwnLens) {
  const CameraCalibration read = ReadZoom("zoom: {}\n");
  ASSERT_TRUE(read.zoom);
  ASSERT_EQ(read.zoom->settings.size(), 1u);
  EXPECT_NEAR(read.zoom->settings[0].view_rad, 2 * std::atan(320.0 / 560), 1e-9);
  EXPECT_FALSE(ReadZoom("").zoom);
}

TEST(CalibrationMount, RefusesBadTablesOfZoom) {
  const auto error_of = [](const std::string& settings) {
    return InputErrorOf([&] { ReadZoom("zoom:\n  settings: " + settings + "\n"); });
  };
  EXPECT_THAT(error_of("wide"), HasSubstr("is no list"));
  EXPECT_THAT(error_of("[[60, 560, 560, 320, 240]]"), HasSubstr("expected [hfov_deg, fu, fv"));
  EXPECT_THAT(error_of("[[x, 560, 560, 320, 240, 0, 0, 0, 0]]"), HasSubstr("list of 9 numbers"));
  EXPECT_THAT(error_of("[[60, -560, 560, 320, 240, 0, 0, 0, 0]]"), HasSubstr("a row whose"));
  EXPECT_THAT(error_of("[[-60, 560, 560, 320, 240, 0, 0, 0, 0]]"),
              HasSubstr("hfov_deg is -60, expected more than 0"));
  EXPECT_THAT(error_of("[[60, 560, 560, 320, 240, 0, 0, 0, 0], "
                       "[60, 570, 560, 320, 240, 0, 0, 0, 0]]"),
              HasSubstr("two rows"));
  EXPECT_THAT(InputErrorOf([] { ReadZoom("zoom: ../zoom0\n"); }),
              HasSubstr("expected the name of a folder, as zoom0"));
}

TEST(CalibrationMount, RefusesContradictoryMounts) {
  ExpectMount(fmt::format("T_cam_imu: {}\nT_imu_cam: {}\n", kCameraFromBody, kBodyFromCamera));
  EXPECT_THAT(
      InputErrorOf([] { Read(fmt::format("T_cam_imu: {0}\nT_imu_cam: {0}\n", kCameraFromBody)); }),
      AllOf(HasSubstr("lens.yaml:2: 'T_imu_cam' is another mount than 'T_cam_imu'")));
}

TEST(CalibrationMount, ReadsRotationAndTranslationOfVins) {
  ExpectMount(
      "extrinsicRotation: [[0, -1, 0], [-1, 0, 0], [0, 0, -1]]\n"
      "extrinsicTranslation: [0.1, 0, -0.05]\n");
  EXPECT_THAT(InputErrorOf([] { Read("extrinsicRotation: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"); }),
              HasSubstr("has no key 'extrinsicTranslation'"));
}

TEST(CalibrationMount, ReadsClockOffsetOfKalibrAndVins) {
  EXPECT_EQ(Read("timeshift_cam_imu: -0.5\n").clock_offset, DurationFromSeconds(-0.5));
  EXPECT_EQ(Read("td: 0.25\n").clock_offset, DurationFromSeconds(0.25));
}

}  // namespace
}  // namespace kestrel
