// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/evaluation/evaluate_follow.h"
#include "kestrel/app/evaluation/evaluate_hunt.h"
#include "kestrel/app/evaluation/evaluate_landing.h"
#include "kestrel/app/evaluation/test_flight.h"
#include "kestrel/io/recording/tables/follow_csv.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class EvaluateTest : public ::testing::Test {
 protected:
  // The pattern is straight below in each image; it is found in the first and missed in the second.
  void WriteLanding() const {
    std::string truth = kPatternHeader;
    for (int i = 0; i < 5; ++i) {
      truth += fmt::format("{},0,0,0,1,0,0,0,0,0,0,320,240,4,1\n", TestFlight::TimeNs(i));
    }
    files_.WriteTruth("landing_pattern0/data.csv", truth);
    files_.WriteResult("landing_detections.csv",
                       std::string(kDetectionHeader) +
                           "a,100000000,1,320,240,lines,1,0,0,4.1,0,0,-0.1,0,0.1,0.1,0.1,,1\n"
                           "b,200000000,0,,,,,,,,,,,,,,,ring,1\n");
  }
  void WriteHunt() const {
    files_.WriteTruth("objects0/objects.csv",
                      "#id [],class [],diameter [m],shape []\n1,red,0.2,cuboid\n");
    files_.WriteTruth("objects0/digits.csv", "#id [],digit [],yaw [rad]\n1,6,0\n");
    files_.WriteTruth(
        "objects0/data.csv",
        "#timestamp [ns],id [],p_WO_W_x [m],p_WO_W_y [m],p_WO_W_z [m],v_WO_W_x [m "
        "s^-1],v_WO_W_y [m s^-1],v_WO_W_z [m s^-1],u [px],v [px],visible_fraction []\n"
        "100000000,1,0,0,0,0,0,0,320,240,1\n");
    files_.WriteResult(
        "object_detections.csv",
        "frame,timestamp_ns,u_px,v_px,semi_major_px,semi_minor_px,angle_rad,class,class_"
        "probability,p_CO_C_x_m,p_CO_C_y_m,p_CO_C_z_m,p_WO_W_x_m,p_WO_W_y_m,p_WO_W_z_m,sigma_m,"
        "roundness,circularity,pixels,detect_ms,shape,digit,digit_probability\n"
        "a,100000000,320,241,10,10,0,red,0.98,0,0,4.04,0,0,0,0.1,1,1,300,1,cuboid,9,0.6\n"
        "b,200000000,,,,,,,,,,,,,,,,,,1,,,\n");
  }
  std::string LandingError() const {
    return InputErrorOf([&] { EvaluateLanding(files_.recording(), files_.output()); });
  }

  TestFlight files_;
};

// Images of a thing that is seen, on a look-alike, beside both, hidden, and found again.
TEST_F(EvaluateTest, FollowReportCountsEachVerdict) {
  constexpr const char* kHeader =
      "#timestamp [ns],x [px],y [px],width [px],height [px],p_WR_W_x [m],p_WR_W_y [m],p_WR_W_z [m],"
      "v_WR_W_x [m s^-1],v_WR_W_y [m s^-1],v_WR_W_z [m s^-1],visible_fraction []\n";
  std::string truth = kHeader, other = kHeader, rows = FollowCsvHeader();
  const double visible[] = {1, 1, 1, 0, 1};
  const char* boxes[] = {"104,100,20,40", "300,100,20,40", "200,300,20,40", "100,100,20,40",
                         "100,100,20,40"};
  const char* places[] = {"2.0,0.3,0,,,,0.2,0.1", "5,5,0,,,,1,1", "5,5,0,,,,1,1", "2,0,0,,,,1,1",
                          "2.0,0.3,0,,,,0.2,0.1"};
  for (int i = 0; i < 5; ++i) {
    truth += fmt::format("{},100,100,20,40,2,0,0,1,0,0,{}\n", TestFlight::TimeNs(i), visible[i]);
    other += fmt::format("{},300,100,20,40,4,0,0,1,0,0,1\n", TestFlight::TimeNs(i));
    rows +=
        fmt::format("{},{},following,{},0.9,{},1\n", i, TestFlight::TimeNs(i), boxes[i], places[i]);
  }
  files_.WriteTruth("region0/data.csv", truth);
  files_.WriteTruth("region1/data.csv", other);
  files_.WriteResult("follow_track.csv", rows);
  const std::string page = ToMarkdown(EvaluateFollow(files_.recording(), files_.output()));
  EXPECT_THAT(page, HasSubstr("| 5 | 4 | 2 | 1 | 1 | 1 | 0.8"));
  EXPECT_THAT(page, HasSubstr("| 2 | 0.300 | 0.300 | 8.85 |")) << "across the line of sight";
  EXPECT_THAT(page, HasSubstr("| 0.10 | 0.00 |"));
}

TEST_F(EvaluateTest, LandingReportHasTablesAndPlots) {
  WriteLanding();
  const Report report = EvaluateLanding(files_.recording(), files_.output());
  const std::string page = ToMarkdown(report);
  EXPECT_THAT(page, HasSubstr("| 5 | 2 | 2 | 2 | 1 | 0 |"));
  EXPECT_THAT(page, HasSubstr("| all | 2 to 6 | 2 | 1 | 50.0 |"));
  EXPECT_THAT(page, Not(HasSubstr("Errors of the track")));

  const std::string folder = files_.output() + "/evaluation";
  WriteReport(report, OutputFolder(folder, /*replace_files=*/false));
  for (const char* name : {"report.md", "success.csv", "errors.csv", "plane.png", "error.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder + "/" + name)) << name;
  }
}

TEST_F(EvaluateTest, EvaluatesLandingWithTrackAndPredictions) {
  WriteLanding();
  files_.WriteResult("landing_track.csv",
                     "timestamp_ns,state,p_x_m,p_y_m,p_z_m,v_x_mps,v_y_mps,v_z_mps,heading_rad,"
                     "turn_rate_radps,sigma_p_m,sigma_v_mps\n"
                     "100000000,tracking,0.3,0.4,0,0,0,0,0,0,0.5,0.1\n200000000,lost,,,,,,,,,,\n");
  files_.WriteResult("landing_prediction.csv",
                     "timestamp_ns,horizon_s,p_x_m,p_y_m,p_z_m\n100000000,0.2,0,0.25,0\n");
  const std::string page = ToMarkdown(EvaluateLanding(files_.recording(), files_.output()));
  EXPECT_THAT(page, HasSubstr("| all | 1 | 0.500 |"));
  EXPECT_THAT(page, HasSubstr("| 0.2 | 1 | 0.250 |"));
}

TEST_F(EvaluateTest, HuntReportHasTables) {
  WriteHunt();
  const std::string page = ToMarkdown(EvaluateHunt(files_.recording(), files_.output()));
  EXPECT_THAT(page, HasSubstr("| red | 1 | 1 | 100.0 | 20.7 to 100.0 | 1 | 0 | 100.0 | 100.0 | "
                              "100.0 | 1.00 | 1.00 | 1.00 | 0.000 | 0.000 |"));
  EXPECT_THAT(page, HasSubstr("| class | 0.9 to 0.99 | 1 | 98.0 | 100.0 |"));
  EXPECT_THAT(page, HasSubstr("| digit | 0.5 to 0.7 | 1 | 60.0 | 0.0 |")) << "a 6 is no 9";
}

TEST_F(EvaluateTest, ReportsMissingFilesAndRows) {
  EXPECT_THAT(LandingError(), HasSubstr("landing_pattern0/data.csv"));
  WriteLanding();
  files_.WriteResult("landing_detections.csv", "");
  EXPECT_THAT(LandingError(), HasSubstr("landing_detections.csv: is empty"));
  files_.WriteResult("landing_detections.csv", kDetectionHeader);
  EXPECT_THAT(LandingError(), HasSubstr("no rows"));
  EXPECT_THAT(InputErrorOf([&] { EvaluateLanding(files_.output(), files_.output()); }),
              HasSubstr("no recording"));
}

TEST_F(EvaluateTest, RefusesRowsOfAnotherRecording) {
  WriteLanding();
  const std::string miss = ",0,,,,,,,,,,,,,,,ring,1\n";
  files_.WriteResult("landing_detections.csv", kDetectionHeader + ("a,150000000" + miss));
  EXPECT_THAT(LandingError(), HasSubstr("timestamp 150000000 is not that of an image"));
  files_.WriteResult("landing_detections.csv",
                     kDetectionHeader + ("a,200000000" + miss) + "b,100000000" + miss);
  EXPECT_THAT(LandingError(), HasSubstr("line 3: timestamp 100000000 out of order"));
  files_.WriteResult(
      "landing_detections.csv",
      std::string(kDetectionHeader) + "a,100000000,1,320,240,lines,1,0,0,4,0,0,0,0,0.1,0,0.1,,1\n");
  EXPECT_THAT(LandingError(), HasSubstr("a sigma is not positive"));
}

}  // namespace
}  // namespace kestrel
