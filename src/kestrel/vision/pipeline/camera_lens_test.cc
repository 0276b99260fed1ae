// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/camera_lens.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

Time AfterStart(double seconds) { return Time(DurationFromSeconds(seconds)); }

CameraCalibration Zooming() {
  CameraCalibration camera;
  camera.intrinsics = {640, 480, 560, 560, 319.5, 239.5, DistortionModel::kNone, {}};
  camera.zoom = ZoomLens{{{ViewOf(camera.intrinsics), camera.intrinsics}}, {}};
  return camera;
}

// Ground with fine and coarse patches, 'factor' times as large, in the middle of the image.
cv::Mat View(double factor) {
  static const cv::Mat ground = [] {
    Random random(3);
    cv::Mat sum(1440, 1920, CV_8UC1, cv::Scalar(0));
    for (const int patches : {240, 60, 15}) {
      cv::Mat noise(patches * 3 / 4, patches, CV_8UC1);
      for (std::size_t i = 0; i < noise.total(); ++i) {
        noise.data[i] = static_cast<std::uint8_t>(random.Integer(10, 75));
      }
      cv::resize(noise, noise, sum.size(), 0, 0, cv::INTER_CUBIC);
      sum += noise;
    }
    return sum;
  }();
  cv::Mat view;
  const cv::Matx23d map(factor, 0, 320 - 960 * factor, 0, factor, 240 - 720 * factor);
  cv::warpAffine(ground, view, map, {640, 480}, cv::INTER_AREA);
  return view;
}

TEST(CameraLensTest, ReportedViewIsThatOfLensAtRest) {
  CameraLens lens(Zooming(), 10);
  EXPECT_FALSE(lens.ViewAt(View(1), AfterStart(0)));
  lens.Add({AfterStart(0.05), 1});
  EXPECT_EQ(lens.ViewAt(View(1), AfterStart(0.1)), 1);
}

TEST(CameraLensTest, ClocksOfImagesAndZoomCount) {
  CameraCalibration camera = Zooming();
  camera.clock_offset = std::chrono::seconds(5);
  camera.zoom->clock_offset = std::chrono::seconds(3);
  CameraLens lens(camera, 10);
  lens.Add({AfterStart(2.05), 1});
  EXPECT_FALSE(lens.ViewAt(View(1), AfterStart(0)));
  EXPECT_EQ(lens.ViewAt(View(1), AfterStart(0.1)), 1);
}

TEST(CameraLensTest, SwitchOfSensorIsSeenInBackground) {
  for (const double factor : {0.34, 0.5, 0.7, 1.4, 2.0, 3.0}) {
    CameraLens lens(Zooming(), 10);
    lens.Add({AfterStart(0), 1});
    const double before = factor < 1 ? 1 : 0.5;
    EXPECT_TRUE(lens.ViewAt(View(before), AfterStart(0.1))) << factor;
    EXPECT_TRUE(lens.ViewAt(View(before), AfterStart(0.2))) << factor;
    EXPECT_FALSE(lens.ViewAt(View(before * factor), AfterStart(0.3))) << factor;
    EXPECT_FALSE(lens.ViewAt(View(before * factor), AfterStart(0.4))) << factor;
    lens.Add({AfterStart(0.45), 1 / factor});
    EXPECT_FALSE(lens.ViewAt(View(before * factor), AfterStart(0.5)))
        << factor;  // it differs: in motion
    lens.Add({AfterStart(0.55), 1 / factor});
    EXPECT_EQ(lens.ViewAt(View(before * factor), AfterStart(0.6)), 1 / factor);
  }
}

TEST(CameraLensTest, DescentIsNoSwitch) {
  CameraLens lens(Zooming(), 10);
  lens.Add({AfterStart(0), 1});
  double factor = 0.5;
  for (int i = 1; i < 10; ++i, factor *= 1.1) {
    EXPECT_TRUE(lens.ViewAt(View(factor), AfterStart(0.1 * i))) << i;
  }
}

}  // namespace
}  // namespace kestrel
