// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/calibration_monitor.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

// Views through a lens, each from its own side unless 'turn' is 0. A view determines two of four
// numbers: each combines the focal length with a part of the principal point and the distortion.
struct Views {
  Eigen::Vector4d error = Eigen::Vector4d::Zero();  // error of the calibration
  double outliers = 0;                              // share of the views that are completely wrong
  double turn = 0.4;                                // rad

  TargetDetection Next(Random* random) const {
    TargetDetection detection{};
    const double angle = random->Uniform(0, 6.28);
    detection.camera_from_target.rotation = Eigen::AngleAxisd(
        turn * random->Uniform(0.5, 1.5), Eigen::Vector3d(std::cos(angle), std::sin(angle), 0));
    detection.camera_from_target.translation = {0, 0, 3};
    detection.semi_major_px = 50;
    CalibrationEvidence& evidence = detection.diagnostics.calibration;
    evidence.edge_variance = 0.01;
    const bool is_outlier = random->Chance(outliers);
    for (int i = 0; i < 2; ++i) {
      const double sigma = random->Uniform(0.02, 0.1);
      const Eigen::Vector4d direction(0.5, random->Uniform(-1, 1), random->Uniform(-1, 1),
                                      random->Uniform(-0.3, 0.3));
      const double seen =
          is_outlier ? random->Uniform(-1, 1) : direction.dot(error) + sigma * random->Normal();
      evidence.information += direction * direction.transpose() / (sigma * sigma);
      evidence.pull += direction * seen / (sigma * sigma);
    }
    return detection;
  }

  CalibrationMonitor Watch(int views, std::uint64_t seed) const {
    CalibrationMonitor monitor;
    Random random(seed);
    for (int i = 0; i < views; ++i) monitor.Add(Next(&random));
    return monitor;
  }
};

TEST(CalibrationMonitor, EstimatesFocalLengthOfViews) {
  const Views views{{std::log(0.8), 0.03, -0.02, 0.05}};
  double squared_error = 0;
  constexpr int kRuns = 40;
  for (int seed = 0; seed < kRuns; ++seed) {
    const CalibrationMonitor monitor = views.Watch(80, seed);
    ASSERT_TRUE(monitor.Contradiction()) << seed;
    const FocalFactor focal = *monitor.Contradiction();
    EXPECT_EQ(focal.detections, 80);
    EXPECT_NEAR(focal.factor, 0.8, 0.1) << seed;
    EXPECT_LT(focal.sigma, 0.05) << seed;
    squared_error += std::pow((focal.factor - 0.8) / focal.sigma, 2) / kRuns;
  }
  EXPECT_GT(squared_error, 0.3);
  EXPECT_LT(squared_error, 1.7);
}

TEST(CalibrationMonitor, DetectsLargeErrorWithFewViews) {
  const Views views{{std::log(370.0 / 500), 0, 0, 0}};
  for (int seed = 0; seed < 40; ++seed) {
    const auto focal = views.Watch(30, seed).Contradiction();
    ASSERT_TRUE(focal) << seed;
    EXPECT_NEAR(focal->factor, 370.0 / 500, 4 * focal->sigma) << seed;
  }
}

TEST(CalibrationMonitor, IsSilentForRightFocalLength) {
  const Views right, other_center{{0, 0.1, -0.05, 0}}, other_distortion{{0, 0, 0, -0.15}};
  for (const Views& views : {right, other_center, other_distortion}) {
    for (int seed = 0; seed < 100; ++seed) {
      CalibrationMonitor monitor;
      Random random(seed);
      for (int i = 0; i < 100; ++i) {
        monitor.Add(views.Next(&random));
        ASSERT_FALSE(monitor.Contradiction()) << seed << " after " << i;
      }
    }
  }
}

TEST(CalibrationMonitor, IsSilentAboutLessThanOneAndAHalfPercent) {
  EXPECT_FALSE((Views{{0.012, 0, 0, 0}}.Watch(20000, 1).Contradiction()));
}

// Views from one side share the errors of the print.
TEST(CalibrationMonitor, RequiresViewsFromSeveralSides) {
  Views views{{std::log(0.7), 0, 0, 0}};
  views.turn = 0;
  EXPECT_FALSE(views.Watch(300, 1).Focal());
}

TEST(CalibrationMonitor, ToleratesFifthOfWrongViews) {
  Views views{{std::log(0.8), 0, 0, 0}, 0.2};
  EXPECT_NEAR(views.Watch(200, 3).Contradiction()->factor, 0.8, 0.05);
  views.error.setZero();
  for (int seed = 0; seed < 20; ++seed) {
    EXPECT_FALSE(views.Watch(200, seed).Contradiction()) << seed;
  }
}

TEST(CalibrationMonitor, IgnoresViewsWithoutEvidence) {
  CalibrationMonitor monitor;
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    TargetDetection detection = Views().Next(&random);
    detection.diagnostics.calibration = {};
    monitor.Add(detection);
  }
  EXPECT_FALSE(monitor.Focal());
}

TEST(LensWarning, NamesBothFocalLengths) {
  const Views views{{std::log(0.74), 0, 0, 0}};
  EXPECT_THAT(LensWarning(views.Watch(200, 1), 500), HasSubstr("the calibration 500"));
  EXPECT_EQ(LensWarning(Views().Watch(200, 1), 500), "");
}

TEST(LensWarning, CountsMisfits) {
  CalibrationMonitor monitor;
  TargetDetection detection{};
  detection.diagnostics.misfit_px = 0.3;
  detection.diagnostics.misfit_bound_px = 0.5;
  for (int i = 0; i < 30; ++i) monitor.Add(detection);
  EXPECT_EQ(LensWarning(monitor, 370), "");
  detection.diagnostics.misfit_px = 12;
  for (int i = 0; i < 10; ++i) monitor.Add(detection);
  EXPECT_THAT(LensWarning(monitor, 370), HasSubstr("in 10 of 40 frames"));
  detection.diagnostics.misfit_px = detection.diagnostics.misfit_bound_px = 0;  // no edges
  monitor.Add(detection);
  EXPECT_THAT(LensWarning(monitor, 370), HasSubstr("in 10 of 40 frames"));
}

}  // namespace
}  // namespace kestrel
