// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/exposure_drive.h"

#include <vector>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

class FakeCamera : public ExposureActuator {
 public:
  bool SetExposure(double exposure_s) override {
    if (is_there) exposures_s.push_back(exposure_s);
    return is_there;
  }
  bool is_there = true;
  std::vector<double> exposures_s;
};

TEST(ExposureDrive, SetsCameraOnlyWhenExposureChanges) {
  FakeCamera camera;
  ExposureDrive drive({.delay_frames = 0}, 1e-3, &camera);
  const cv::Mat right(8, 8, CV_8UC1, cv::Scalar(220));
  for (int i = 0; i < 5; ++i) drive.Update(right);
  EXPECT_EQ(camera.exposures_s, std::vector<double>{1e-3});
  drive.Update(cv::Mat(8, 8, CV_8UC1, cv::Scalar(110)));
  ASSERT_EQ(camera.exposures_s.size(), 2u);
  EXPECT_NEAR(camera.exposures_s[1], 2e-3, 2e-4);
}

TEST(ExposureDrive, RestoresExposureOfReturnedCamera) {
  FakeCamera camera;
  camera.is_there = false;
  ExposureDrive drive({}, 1e-3, &camera);
  const cv::Mat right(8, 8, CV_8UC1, cv::Scalar(220));
  drive.Update(right);
  EXPECT_FALSE(drive.is_set());
  camera.is_there = true;
  drive.Update(right);
  EXPECT_TRUE(drive.is_set());
  EXPECT_EQ(camera.exposures_s, std::vector<double>{1e-3});
}

TEST(V4l2ExposureActuator, FailsOnMissingDevice) {
  EXPECT_FALSE(V4l2ExposureActuator("/dev/video987").SetExposure(1e-3));
}

}  // namespace
}  // namespace kestrel
