// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/land_task.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/vision/pipeline/test_pattern.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

CameraIntrinsics Camera(double focal_px) {
  return {640, 480, focal_px, focal_px, 319.5, 239.5, DistortionModel::kNone, {}};
}

// The vision of images of a camera whose calibration says 'focal_px'.
std::unique_ptr<Vision> VisionWith(double focal_px, std::optional<double> altitude_m,
                                   bool is_still) {
  SessionCamera camera;
  camera.calibration.intrinsics = Camera(focal_px);
  camera.altitude_m = altitude_m;
  LandingPipelineOptions options;
  options.still = is_still;
  return LandTask(options).MakeVision(camera);
}

constexpr double kFocal_px = 400;  // focal length of the images

TEST(LandTask, WarnsThatTheGivenAltitudeIsWrong) {
  const cv::Mat image = DrawPattern(CameraModel(Camera(kFocal_px)), LandingPattern(),
                                    {Eigen::Quaterniond(0, 1, 0, 0), {0.3, 0.2, 3}});
  const auto warning = [&](double altitude_m) {
    const auto vision = VisionWith(kFocal_px, altitude_m, /*is_still=*/false);
    for (int i = 0; i < 12; ++i) {
      vision->Process({"image", Time(DurationFromSeconds(0.1 * i)), image});
    }
    EXPECT_EQ(vision->Found(), "pattern found in 12");
    return vision->Warning();
  };
  EXPECT_THAT(warning(20), HasSubstr("set --altitude 3.0"));
  EXPECT_EQ(warning(3), "");
}

TEST(LandTask, RefusesAnAltitudeInMillimetres) {
  EXPECT_THAT(InputErrorOf([] { VisionWith(kFocal_px, 1500, /*is_still=*/false); }),
              HasSubstr("altitude_m is 1500, expected metres: 1.5?"));
}

TEST(LandTask, RemarksThatTheLensIsAnother) {
  Random random(1);
  std::vector<cv::Mat> images;
  for (int i = 0; i < 30; ++i) {
    images.push_back(DrawRandomView(CameraModel(Camera(kFocal_px)), LandingPattern(), &random));
  }
  const auto remarks = [&](double focal_px) {
    const auto vision = VisionWith(focal_px, /*altitude_m=*/std::nullopt, /*is_still=*/true);
    for (const cv::Mat& image : images) vision->Process({"image", Time(), image});
    return vision->Remarks();
  };
  EXPECT_THAT(remarks(kFocal_px), Not(HasSubstr("the pattern says")));
  EXPECT_THAT(remarks(540), HasSubstr("px, the calibration 540: kestrel calibrate lens"));
}

// Two cameras whose clocks differ by a second; the second one sends no images after the first of
// them.
TEST(LandTask, SeveralCamerasHaveTablesOfTheirOwnAndFaultsAreInTheSummary) {
  const cv::Mat image = DrawPattern(CameraModel(Camera(kFocal_px)), LandingPattern(),
                                    {Eigen::Quaterniond(0, 1, 0, 0), {0.3, 0.2, 3}});
  SessionCamera camera;
  camera.calibration.intrinsics = Camera(kFocal_px);
  camera.calibration.name = "cam0";
  camera.further = {camera.calibration};
  camera.further[0].name = "cam1";
  camera.further[0].clock_offset = std::chrono::seconds(1);
  const auto vision = LandTask(LandingPipelineOptions()).MakeVision(camera);
  EXPECT_EQ(vision->pose_lead(), std::chrono::seconds(1));
  const TestFolder folder;
  const auto tables = vision->MakeTables({.folder = folder / "output"});
  const auto process = [&](std::size_t index, double time_s) {
    Frame frame{"image", Time(DurationFromSeconds(time_s)), image.clone()};
    frame.image.at<std::uint8_t>(0, 0) = static_cast<std::uint8_t>(50 * time_s);
    frame.camera = index;
    tables->Take(vision->Process(frame));
  };
  process(1, 4);  // on the clock of the other one: 5 s
  for (int i = 0; i < 15; ++i) process(0, 5 + 0.1 * i);
  tables->Finish();
  EXPECT_EQ(vision->Found(), "pattern found in 16, cam0 15 of 15, cam1 1 of 1");
  EXPECT_THAT(vision->Remarks(), HasSubstr("at 1.10 s cam1 sends no images"));
  const std::string first = ReadFile(folder / "output/landing_detections.csv");
  const std::string second = ReadFile(folder / "output/landing_detections_cam1.csv");
  EXPECT_EQ(std::count(first.begin(), first.end(), '\n'), 16);
  EXPECT_THAT(second, HasSubstr("image,4000000000,1,"));
}

TEST(Task, WritesATrackOrAMapOnlyOfFramesThatFollowEachOther) {
  const TestFolder folder;
  for (const auto& [task, file] :
       {std::pair("land", "landing_track.csv"), std::pair("hunt", "object_map.csv")}) {
    for (const bool is_still : {false, true}) {
      TaskOptions options;
      options.landing.still = options.hunt.still = is_still;
      SessionCamera camera{.calibration = {}, .has_world = true};
      camera.calibration.intrinsics = Camera(kFocal_px);
      const auto vision = MakeTask(task, options)->MakeVision(camera);
      const std::string output = folder / (task + std::to_string(is_still));
      vision->MakeTables({.folder = output})->Finish();
      EXPECT_EQ(std::filesystem::exists(output + "/" + file), !is_still) << task;
    }
  }
}

}  // namespace
}  // namespace kestrel
