// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/rectified_print.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "kestrel/landing/test_prints.h"

namespace kestrel {
namespace {

class RectifiedPrintTest : public ::testing::Test {
 protected:
  using Light = SmallPatternFitter::Light;

  std::optional<SmallPatternFitter::Fit> Compare(const Print& print, const RigidTransform& pose,
                                                 Light light = Light::kEven) {
    return Compare(DrawPrint(camera_, pattern_, print, pose), pose, light);
  }
  std::optional<SmallPatternFitter::Fit> Compare(const cv::Mat& image, const RigidTransform& pose,
                                                 Light light = Light::kEven) {
    const PatternView view(camera_, pose, rectified_.extent_m(), {});
    EXPECT_TRUE(view.valid());
    rectified_.Rectify(image, view, &buffers_);
    return rectified_.Compare(buffers_, light, &workspace_);
  }

  const LandingPattern pattern_{};
  const CameraModel camera_ = TestPrintCamera();
  const RectifiedPrint rectified_{pattern_};
  RectifiedPrintBuffers buffers_;
  SmallPatternWorkspace workspace_;
};

TEST_F(RectifiedPrintTest, ThePrintIsRecognizedFromAllSides) {
  Random random(1);
  for (const double distance : {0.9, 1.6, 3.0, 5.0}) {
    for (int trial = 0; trial < 4; ++trial) {
      const RigidTransform pose =
          PrintPose({random.Uniform(-0.05, 0.05) * distance, random.Uniform(-0.05, 0.05) * distance,
                     distance},
                    random.Uniform(0, 0.9), random.Uniform(0, 6), random.Uniform(0, 6));
      const auto fit = Compare(SpokedPrint(pattern_, 4), pose);
      ASSERT_TRUE(fit) << distance;
      EXPECT_GT(fit->correlation, 0.96) << distance;
      EXPECT_GT(fit->others.cross_correlation, 0.95) << distance;
      EXPECT_GT(fit->match.Agreement(), 0.85) << distance;
    }
  }
}

TEST_F(RectifiedPrintTest, OtherFiguresAreNot) {
  const RigidTransform pose = PrintPose({0.05, -0.05, 1.6}, 0.4, 1, 0.3);
  const Print empty = [this](double x, double y) { return IsRing(pattern_, x, y); };
  for (const Print& print : {SpokedPrint(pattern_, 2), SpokedPrint(pattern_, 3),
                             SpokedPrint(pattern_, 5), SpokedPrint(pattern_, 8), empty}) {
    const auto fit = Compare(print, pose);
    EXPECT_LT(fit ? fit->others.cross_correlation : 0, 0.9);
  }
}

TEST_F(RectifiedPrintTest, XIsAlongAnArmAndYUp) {
  // A print whose white is dark where x and y are positive.
  const Print marked = [](double x, double y) { return x > 0 && y > 0; };
  const RigidTransform pose = PrintPose({0, 0, 1.6}, 0.3, 1, 0.5);
  const PatternView view(camera_, pose, rectified_.extent_m(), {});
  rectified_.Rectify(DrawPrint(camera_, pattern_, marked, pose), view, &buffers_);
  const cv::Mat& gray = buffers_.gray;
  const int near = gray.cols / 4, far = 3 * gray.cols / 4;
  EXPECT_LT(gray.at<std::uint8_t>(near, far), 60) << "x to the right, y up";
  EXPECT_GT(gray.at<std::uint8_t>(near, near), 180);
  EXPECT_GT(gray.at<std::uint8_t>(far, near), 180);
  EXPECT_GT(gray.at<std::uint8_t>(far, far), 180);
}

TEST_F(RectifiedPrintTest, WhatIsOutOfViewIsMasked) {
  const RigidTransform pose = PrintPose({1.4, 0, 2}, 0, 0, 0);  // its centre 5 px from the border
  const auto fit = Compare(SpokedPrint(pattern_, 4), pose);
  const double seen = cv::countNonZero(buffers_.seen) / static_cast<double>(buffers_.seen.total());
  EXPECT_NEAR(seen, 0.5, 0.05);
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->correlation, 0.95) << "what is in view is the print";
  EXPECT_LT(fit->match.seen, 0.8);
}

TEST_F(RectifiedPrintTest, ShadowsAreTakenOut) {
  const RigidTransform pose = PrintPose({0, 0, 1.4}, 0.2, 1, 0.3);
  cv::Mat image = DrawPrint(camera_, pattern_, SpokedPrint(pattern_, 4), pose);
  EXPECT_FALSE(Compare(image, pose, Light::kShadows)) << "there are none";
  // Under two rotors.
  for (const cv::Rect& rotor : {cv::Rect(105, 80, 45, 40), cv::Rect(165, 130, 45, 40)}) {
    cv::Mat shaded = image(rotor);
    shaded.convertTo(shaded, CV_8UC1, 0.4);
  }
  const auto even = Compare(image, pose);
  const auto evened = Compare(image, pose, Light::kShadows);
  ASSERT_TRUE(evened);
  EXPECT_GT(evened->others.cross_correlation, 0.9);
  EXPECT_GT(evened->correlation, (even ? even->correlation : 0) + 0.02);
}

}  // namespace
}  // namespace kestrel
