// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/landing_run.h"

#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/test_folder.h"
#include "kestrel/vision/pipeline/test_pattern.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Images without poses, which the test gives to the run itself.
class NoFrames : public FrameSource {
 public:
  bool ReadNext(Frame*) override { return false; }
  std::optional<std::size_t> frame_count() const override { return 0; }
  double rate_hz() const override { return 10; }
};

CameraIntrinsics Camera(double focal_px) {
  return {640, 480, focal_px, focal_px, 319.5, 239.5, DistortionModel::kNone, {}};
}

// A run over images of a camera whose calibration says 'focal_px'.
LandingRun RunWith(double focal_px, std::optional<double> altitude_m, bool is_still) {
  OpenedSource opened{std::make_unique<NoFrames>(), {}};
  opened.calibration.intrinsics = Camera(focal_px);
  LandingPipelineOptions options;
  options.still = is_still;
  return {opened, options, altitude_m};
}

constexpr double kFocal_px = 400;  // of the camera that takes the images

TEST(LandingRun, WarnsOfWrongAltitude) {
  const cv::Mat image = DrawPattern(CameraModel(Camera(kFocal_px)), LandingPattern(),
                                    {Eigen::Quaterniond(0, 1, 0, 0), {0.3, 0.2, 3}});
  const auto warning = [&](double altitude_m) {
    LandingRun run = RunWith(kFocal_px, altitude_m, /*is_still=*/false);
    for (int i = 0; i < 12; ++i) {
      run.Process({"image", Time(DurationFromSeconds(0.1 * i)), image});
    }
    EXPECT_EQ(run.Found(), "pattern found in 12");
    return run.Warning();
  };
  EXPECT_THAT(warning(20), HasSubstr("set --altitude 3.0"));
  EXPECT_EQ(warning(3), "");
}

TEST(LandingRun, RefusesAltitudeInMillimetres) {
  EXPECT_THAT(InputErrorOf([] { RunWith(kFocal_px, 1500, /*is_still=*/false); }),
              HasSubstr("altitude_m is 1500, expected metres: 1.5?"));
}

TEST(LandingRun, ReportsDifferentLens) {
  Random random(1);
  std::vector<cv::Mat> images;
  for (int i = 0; i < 30; ++i) {
    images.push_back(DrawRandomView(CameraModel(Camera(kFocal_px)), LandingPattern(), &random));
  }
  const auto remarks = [&](double focal_px) {
    LandingRun run = RunWith(focal_px, /*altitude_m=*/std::nullopt, /*is_still=*/true);
    for (const cv::Mat& image : images) run.Process({"image", Time(), image});
    return run.Remarks();
  };
  EXPECT_THAT(remarks(kFocal_px), Not(HasSubstr("the pattern says")));
  EXPECT_THAT(remarks(540), HasSubstr("px, the calibration 540: kestrel calibrate lens"));
}

}  // namespace
}  // namespace kestrel
