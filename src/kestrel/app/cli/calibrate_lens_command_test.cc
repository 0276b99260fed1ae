// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/test_command.h"
#include "kestrel/calibration/lens/lens_difference.h"
#include "kestrel/calibration/lens/test_board_images.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/io/recording/test_files.h"
#include "kestrel/simulation/labelled_images/landing_stills.h"
#include "kestrel/vision/pipeline/test_pattern.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

class CalibrateLensCommandTest : public CommandTest {
 protected:
  // Views of the pattern from straight above, at places all over the image.
  void WriteLevelViews() const {
    const CameraModel camera({640, 480, 400, 400, 319.5, 239.5, DistortionModel::kNone, {}});
    for (int i = 0; i < 12; ++i) {
      const RigidTransform camera_from_target = {
          Eigen::Quaterniond(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX())) *
              Eigen::AngleAxisd(0.4 * i, Eigen::Vector3d::UnitZ()),
          {0.5 * (i % 4) - 0.75, 0.5 * (i / 4) - 0.5, 2 + 0.1 * i}};
      WriteTestImage(folder_, fmt::format("level/{:03}.png", i),
                     DrawPattern(camera, LandingPattern(), camera_from_target));
    }
  }
};

TEST_F(CalibrateLensCommandTest, CalibratesLensFromChessboardViews) {
  const CameraModel truth({400, 300, 330, 330, 203, 147, DistortionModel::kNone, {}});
  const std::string board = "chessboard:8x5:0.03";
  for (const LensImage& view : RenderBoard(truth, ParseLensBoard(board), 24, 0.6, 2)) {
    WriteTestImage(folder_, "views/" + view.name + ".png", view.image);
  }
  const std::string views = folder_ / "views";
  const std::string camera = folder_ / "camera.yaml";
  Succeed("calibrate lens " + views + " --board " + board + " --output " + camera);
  EXPECT_NEAR(ReadCalibration(camera).intrinsics.fx_px, 330, 2);
  ExpectInputError("calibrate lens " + views + " --board chessboard:8x5",
                   "chessboard:8x5");
}

TEST_F(CalibrateLensCommandTest, CalibratesFisheyeFromImagesAlone) {
  const CameraIntrinsics truth = PaperCamera();
  const std::string views = folder_ / "views";
  Succeed("simulate landing --scenario stills --seed 8 --set frames=60 --output " + views +
          " --set stills.min_altitude_m=0.7 --set stills.max_altitude_m=2.2"
          " --set stills.max_tilt_deg=50");
  const std::string camera = folder_ / "camera.yaml";
  const std::string plots = folder_ / "plots";
  const Outcome outcome =
      Succeed("calibrate lens " + views + " --output " + camera + " --plots " + plots);
  EXPECT_THAT(outcome.err, HasSubstr("distortion: equidistant: "));
  EXPECT_THAT(outcome.err, HasSubstr(" of 60 images, "));
  EXPECT_THAT(outcome.err, HasSubstr("fields of the image, to "));
  const CameraIntrinsics found = ReadCalibration(camera).intrinsics;
  EXPECT_NEAR(found.fx_px / truth.fx_px, 1, 0.003);
  EXPECT_NEAR(found.fy_px / truth.fy_px, 1, 0.003);
  std::vector<double> differences =
      LensDifferencePx(CameraModel(truth), CameraModel(found), 80 * kPi / 180);
  std::sort(differences.begin(), differences.end());
  EXPECT_LT(differences[differences.size() / 2], 0.11);
  EXPECT_LT(differences.back(), 1);
  for (const char* name : {"lens_residuals.png", "lens_coverage.png"}) {
    EXPECT_GT(std::filesystem::file_size(plots + "/" + name), 1000u);
  }
  // The mount is the recording's.
  const auto own = ReadCalibration(views + "/mav0/cam0/sensor.yaml");
  ASSERT_TRUE(ReadCalibration(camera).body_from_camera.has_value());
  EXPECT_TRUE(
      ReadCalibration(camera).body_from_camera->rotation.isApprox(own.body_from_camera->rotation));
}

TEST_F(CalibrateLensCommandTest, RefusesLevelViewsAndAdvisesToTilt) {
  WriteLevelViews();
  ExpectInputError("calibrate lens " + (folder_ / "level"), "tilt the camera");
}

TEST_F(CalibrateLensCommandTest, ReportsUnusableImages) {
  for (int i = 0; i < 9; ++i) {
    WriteTestImage(folder_, fmt::format("gray/{}.png", i), cv::Mat(240, 320, CV_8UC1, 90));
  }
  ExpectInputError("calibrate lens " + (folder_ / "gray"), "the pattern is in 0 of them");
  WriteTestImage(folder_, "gray/a.png", cv::Mat(480, 640, CV_8UC1, 90));
  ExpectInputError("calibrate lens " + (folder_ / "gray"), "a.png: the image has 640 x 480 px");
  ExpectInputError("calibrate lens " + (folder_ / "nothing"), "nothing");
}

TEST_F(CalibrateLensCommandTest, ExitsWithStatusTwoOnWrongUsage) {
  for (const char* arguments : {"calibrate lens", "calibrate lens a.png --model omni"}) {
    EXPECT_EQ(Run(arguments).status, 2) << arguments;
  }
}

}  // namespace
}  // namespace kestrel
