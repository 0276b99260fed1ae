// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/euroc/euroc_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr char kPoseHeader[] =
    "#timestamp [ns],p_WB_W_x [m],p_WB_W_y [m],p_WB_W_z [m],q_WB_w [],q_WB_x [],q_WB_y [],q_WB_z "
    "[]\n";

std::string PoseError(const std::string& rows) {
  return InputErrorOf([&] { ParsePoseRows(kPoseHeader + rows, "nav0/data.csv"); });
}

TEST(ParseImageRows, ReadsRows) {
  const auto rows = ParseImageRows("#timestamp [ns],filename\n5,5.png\n7,7.png\n", "c.csv");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(ToNanoseconds(rows[1].time), 7);
  EXPECT_EQ(rows[1].filename, "7.png");
}

TEST(ParseImageRows, ReportsLineOfTimesOutOfOrder) {
  for (const char* second : {"4", "5"}) {
    const std::string text =
        std::string("#timestamp [ns],filename\n5,5.png\n") + second + ",4.png\n";
    EXPECT_THAT(InputErrorOf([&] { ParseImageRows(text, "c.csv"); }),
                HasSubstr("c.csv: line 3: timestamp " + std::string(second) + " out of order"));
  }
}

TEST(ParseImageRows, RefusesNonIntegerTime) {
  EXPECT_THAT(InputErrorOf([] { ParseImageRows("timestamp [ns],filename\n1.5,a\n", "c.csv"); }),
              HasSubstr("line 2"));
}

TEST(ParseImageRows, RefusesTimeOutOfRange) {
  for (const char* time : {"-1", "9223372036854775807"}) {
    const std::string text = std::string("timestamp [ns],filename\n") + time + ",a\n";
    EXPECT_THAT(InputErrorOf([&] { ParseImageRows(text, "c.csv"); }),
                HasSubstr("line 2: timestamp"));
  }
}

TEST(ParsePoseRows, ReadsPosesInAnyOrderOfColumns) {
  const auto poses = ParsePoseRows(
      "q_WB_z[],q_WB_y[],q_WB_x[],q_WB_w[],p_WB_W_z[m],p_WB_W_y[m],p_WB_W_x[m],timestamp[ns]\n"
      "0.6,0,0,0.8,3,2,1,42\n",
      "n.csv");
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(ToNanoseconds(poses[0].time), 42);
  EXPECT_EQ(poses[0].world_from_body.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(poses[0].world_from_body.rotation.w(), 0.8, 1e-12);
  EXPECT_NEAR(poses[0].world_from_body.rotation.z(), 0.6, 1e-12);
}

TEST(ParsePoseRows, RefusesInvalidPose) {
  EXPECT_EQ(PoseError("1,0,0,0,1,0,0,0\n"), "");
  EXPECT_THAT(PoseError("1,0,0,nan,1,0,0,0\n"), HasSubstr("line 2: p_WB_W_z [m] is 'nan'"));
  EXPECT_THAT(PoseError("1,0,0,0,1,0,0,0\n2,0,0,0,0.5,0,0,0\n"),
              HasSubstr("line 3: the quaternion q_WB has the length 0.5, expected 1"));
  EXPECT_THAT(PoseError("1,0,0,0,1e200,1e200,0,0\n"), HasSubstr("quaternion"));
  EXPECT_THAT(PoseError("2,0,0,0,1,0,0,0\n1,0,0,0,1,0,0,0\n"), HasSubstr("out of order"));
  EXPECT_THAT(PoseError("1,0,0,0,1,0,0\n"), HasSubstr("7 columns, expected 8"));
}

class EurocRecordingTest : public ::testing::Test {
 protected:
  EurocRecordingTest() {
    folder_.Write("mav0/cam0/data.csv", "#timestamp [ns],filename\n100,100.png\n200,200.png\n");
    WriteTestImage(folder_, "mav0/cam0/data/100.png", cv::Mat(2, 3, CV_8UC1, 9));
    WriteTestImage(folder_, "mav0/cam0/data/200.png", cv::Mat(2, 3, CV_8UC1, 9));
  }

  TestFolder folder_;
};

TEST_F(EurocRecordingTest, NamesAreRelativeToGivenFolder) {
  Frame frame;
  ImageSequence whole = OpenEurocRecording(folder_.path());
  ASSERT_TRUE(whole.Next(&frame));
  EXPECT_EQ(frame.name, "mav0/cam0/data/100.png");
  EXPECT_EQ(ToNanoseconds(frame.time), 100);
  ImageSequence inner = OpenEurocRecording(folder_ / "mav0");
  ASSERT_TRUE(inner.Next(&frame));
  EXPECT_EQ(frame.name, "cam0/data/100.png");
}

TEST_F(EurocRecordingTest, CalibrationAndPosesMayBeAbsent) {
  const ImageSequence source = OpenEurocRecording(folder_.path());
  EXPECT_EQ(source.calibration_file(), "");
  EXPECT_THAT(source.poses(), IsEmpty());
}

TEST_F(EurocRecordingTest, FindsCalibrationAndPoses) {
  const std::string calibration = folder_.Write("mav0/cam0/sensor.yaml", "sensor_type: camera\n");
  folder_.Write("mav0/nav0/data.csv", std::string(kPoseHeader) + "100,1,2,3,1,0,0,0\n");
  const ImageSequence source = OpenEurocRecording(folder_.path());
  EXPECT_EQ(source.calibration_file(), calibration);
  EXPECT_EQ(source.poses().size(), 1u);
}

TEST_F(EurocRecordingTest, SkipsAndReportsMissingImage) {
  std::filesystem::remove(folder_ / "mav0/cam0/data/200.png");
  ImageSequence source = OpenEurocRecording(folder_.path());
  Frame frame;
  EXPECT_TRUE(source.Next(&frame));
  std::string fault;
  source.set_on_broken([&](const BrokenImage& broken) { fault = broken.what(); });
  source.Next(&frame);
  EXPECT_THAT(fault, HasSubstr("200.png: no such file"));
}

TEST_F(EurocRecordingTest, RefusesRecordingWithoutRowsOrList) {
  folder_.Write("mav0/cam0/data.csv", "#timestamp [ns],filename\n");
  EXPECT_THAT(InputErrorOf([&] { OpenEurocRecording(folder_.path()); }), HasSubstr("no rows"));
  std::filesystem::remove(folder_ / "mav0/cam0/data.csv");
  EXPECT_THAT(InputErrorOf([&] { OpenEurocRecording(folder_.path()); }),
              HasSubstr("data.csv: no such file"));
}

}  // namespace
}  // namespace kestrel
