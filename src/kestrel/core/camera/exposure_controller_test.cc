// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/exposure_controller.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

constexpr double kFullLight_s = 0.001;  // exposure at which white in full light has gray 220

// A camera in front of a scene with all brightnesses. The first 'delay' images after a new exposure
// still have the old one.
class DelayedCamera {
 public:
  DelayedCamera(double exposure_s, int delay, double gamma = 1)
      : exposures_s_(delay, exposure_s), gamma_(gamma) {}

  void SetLight(double light) { light_ = light; }

  cv::Mat Take(double exposure_s) {
    exposures_s_.push_back(exposure_s);
    const double gain = light_ * exposures_s_.front() / kFullLight_s;
    exposures_s_.pop_front();
    cv::Mat image(120, 160, CV_8UC1);
    for (int u = 0; u < image.cols; ++u) {
      const double linear = 4 + 216 * gain * u / (image.cols - 1);
      const double gray = 255 * std::pow(std::min(linear, 255.0) / 255, gamma_);
      image.col(u) = cv::Scalar(std::round(gray));
    }
    return image;
  }

 private:
  std::deque<double> exposures_s_;
  double gamma_;
  double light_ = 1;
};

int Brightest(const cv::Mat& image) {
  double brightest = 0;
  cv::minMaxLoc(image, nullptr, &brightest);
  return static_cast<int>(brightest);
}

// Number of images until the brightest part is in range and stays there for 30 more; 1000 if never.
int FramesToSettle(ExposureController* controller, DelayedCamera* camera) {
  constexpr int kLongest = 60;
  constexpr int kStays = 30;
  int settled = 0;
  for (int i = 0; i < kLongest; ++i) {
    const cv::Mat image = camera->Take(controller->exposure_s());
    const int gray = Brightest(image);
    settled = gray >= 200 && gray <= 240 ? settled + 1 : 0;
    if (settled > kStays) return i - kStays;
    controller->Update(image);
  }
  return 1000;
}

TEST(ExposureControllerTest, KeepsGoodExposure) {
  ExposureController controller({}, kFullLight_s);
  DelayedCamera camera(kFullLight_s, 2);
  EXPECT_EQ(FramesToSettle(&controller, &camera), 0);
  EXPECT_EQ(controller.exposure_s(), kFullLight_s);
}

TEST(ExposureControllerTest, FollowsLightStepsWithoutOscillation) {
  for (const double gamma : {1.0, 0.45}) {
    for (const int delay : {0, 1, 2}) {
      ExposureController controller({.gamma = gamma}, kFullLight_s);
      DelayedCamera camera(kFullLight_s, delay, gamma);
      for (const double light : {1.0, 1.5, 50.0, 1.0, 10.0, 0.2, 1.0}) {
        camera.SetLight(light);
        EXPECT_LE(FramesToSettle(&controller, &camera), 15)
            << "light " << light << ", delay " << delay << ", gamma " << gamma;
      }
    }
  }
}

TEST(ExposureControllerTest, RecoversFromSaturatedAndBlackImages) {
  ExposureController controller({}, 0.01);
  DelayedCamera camera(0.01, 2);
  EXPECT_EQ(Brightest(camera.Take(0.01)), 255);
  EXPECT_LE(FramesToSettle(&controller, &camera), 12);
  controller = ExposureController({}, 2e-5);
  camera = DelayedCamera(2e-5, 2);
  EXPECT_LE(Brightest(camera.Take(2e-5)), 8);
  EXPECT_LE(FramesToSettle(&controller, &camera), 12);
}

TEST(ExposureControllerTest, StaysWithinLimitsOfCamera) {
  ExposureController controller({.min_exposure_s = 5e-4, .max_exposure_s = 2e-3}, 1);
  EXPECT_EQ(controller.exposure_s(), 2e-3);
  const cv::Mat black(120, 160, CV_8UC1, cv::Scalar(0));
  const cv::Mat white(120, 160, CV_8UC1, cv::Scalar(255));
  for (int i = 0; i < 10; ++i) controller.Update(white);
  EXPECT_EQ(controller.exposure_s(), 5e-4);
  for (int i = 0; i < 10; ++i) controller.Update(black);
  EXPECT_EQ(controller.exposure_s(), 2e-3);
}

TEST(ExposureControllerTest, WeightsPatternMoreThanGlint) {
  cv::Mat image(120, 160, CV_8UC1, cv::Scalar(60));
  const cv::Rect pattern(40, 40, 30, 30);
  image(pattern) = cv::Scalar(220);
  image(cv::Rect(100, 0, 60, 60)) = cv::Scalar(255);  // the sky
  image(cv::Rect(45, 45, 4, 4)) = cv::Scalar(255);
  ExposureController controller({}, kFullLight_s);
  EXPECT_EQ(controller.Update(image, pattern), kFullLight_s);
  EXPECT_LT(controller.Update(image), kFullLight_s);
}

TEST(ExposureControllerTest, AcceptsAreaOutsideImage) {
  const cv::Mat image(120, 160, CV_8UC1, cv::Scalar(110));
  for (const cv::Rect area : {cv::Rect(150, 110, 50, 50), cv::Rect(500, 500, 9, 9)}) {
    ExposureController controller({.black_gray = 0}, kFullLight_s);
    EXPECT_NEAR(controller.Update(image, area), 2 * kFullLight_s, 1e-9);
  }
}

TEST(ExposureControllerTest, ReportsFaultyOptions) {
  ExposureOptions options;
  options.low_gray = 250;
  options.min_exposure_s = 1;
  try {
    const ExposureController controller(options, 0.001);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("high_gray is 240, expected more than 250"));
    EXPECT_THAT(error.what(), HasSubstr("max_exposure_s is 0.01, expected 1 or more"));
  }
}

}  // namespace
}  // namespace kestrel
