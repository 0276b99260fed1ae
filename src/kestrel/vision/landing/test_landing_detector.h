// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {

// Fixture: a detector, its camera, and prints drawn for it.
class LandingPatternDetectorTest : public ::testing::Test {
 protected:
  cv::Mat Draw(const Print& print, const RigidTransform& pose) const {
    return DrawPrint(camera_, pattern_, print, pose);
  }
  TargetReport Detect(const cv::Mat& image, const TargetHint& hint = {}) {
    return detector_.Detect(image, hint, workspace_);
  }

  const LandingPattern pattern_{};
  const CameraModel camera_ = TestPrintCamera();
  const LandingPatternDetector detector_{camera_, {}};
  LandingWorkspace workspace_;
  const RigidTransform pose_ = PrintPose({0.15, -0.1, 3}, 0.25, 1, 0.3);
  const cv::Mat image_ = DrawPrint(camera_, pattern_, SpokedPrint(pattern_, 4), pose_);
};

// Expects two reports of one image to be equal except for the times.
inline void ExpectSame(const TargetReport& a, const TargetReport& b) {
  EXPECT_EQ(a.reached, b.reached);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.diagnostics.candidates, b.diagnostics.candidates);
  ASSERT_EQ(a.detection.has_value(), b.detection.has_value());
  if (!a.detection) return;
  EXPECT_EQ(a.detection->center_px, b.detection->center_px);
  EXPECT_EQ(a.detection->camera_from_target.translation,
            b.detection->camera_from_target.translation);
  EXPECT_EQ(a.detection->covariance, b.detection->covariance);
  EXPECT_EQ(a.detection->quality, b.detection->quality);
  EXPECT_EQ(a.detection->method, b.detection->method);
}

}  // namespace kestrel
