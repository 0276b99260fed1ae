// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/small_pattern/small_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "kestrel/vision/landing/small_pattern/small_pattern_model.h"
#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

class SmallPatternTest : public ::testing::Test {
 protected:
  static RigidTransform PoseOf(double diameter_px, Random* random) {
    const double distance = 220 / diameter_px;
    return PrintPose(
        {random->Uniform(-0.2, 0.2) * distance, random->Uniform(-0.2, 0.2) * distance, distance},
        random->Uniform(0, 0.3), random->Uniform(0, 6), random->Uniform(0, 6));
  }
  using Light = SmallPatternFitter::Light;

  // Fits from the ring of 'truth' with an error of 3 % in distance.
  std::optional<SmallPatternFitter::Fit> Fit(const cv::Mat& image, const RigidTransform& truth) {
    const CirclePose ring{1.03 * truth.translation, truth.rotation * Eigen::Vector3d::UnitZ()};
    constexpr std::array<double, 1> kOneScale{1.0};
    constexpr std::array<double, 6> kTurns{0, 0.26, 0.52, 0.79, 1.05, 1.31};
    if (!fitter_.FindScale(image, ring, kOneScale, &workspace_)) return std::nullopt;
    const auto start = fitter_.FindStart(ring, 1, kTurns, &workspace_);
    return fitter_.Refine(image, start.camera_from_target, Light::kEven, 8, &workspace_);
  }
  // Fits a print at its true pose, so that light and blur change little.
  std::optional<SmallPatternFitter::Fit> FitInPlace(const cv::Mat& image,
                                                    const RigidTransform& truth, Light light) {
    return fitter_.Refine(image, truth, light, 3, &workspace_);
  }
  static double Agreement(const SmallPatternFitter::Fit& fit) {
    return std::min(fit.shares.MeansInView().ring, fit.shares.MeansInView().arms);
  }
  // Amplitude of the part that is least like that of the print.
  static double LeastPart(const SmallPatternFitter::Fit& fit) {
    return std::min(fit.shares.MeansInView().ring, fit.shares.MeansInView().worst_arm);
  }
  // Returns the root mean square of error over standard deviation of 100 fits, for each component.
  Eigen::Vector3d RatiosOfErrors(double noise) {
    Random random(3);
    const RigidTransform truth = PoseOf(22, &random);
    const cv::Mat image = Draw(SpokedPrint(pattern_, 4), truth);
    constexpr int kTrials = 100;
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto fit = Fit(AddNoise(image, noise, &random), truth);
      if (!fit) return Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
      const auto error = PoseError(fit->location.camera_from_target, truth);
      for (int k = 0; k < 3; ++k) sum(k) += error(k) * error(k) / fit->location.covariance(k, k);
    }
    return (sum / kTrials).sqrt();
  }
  cv::Mat Draw(const Print& print, const RigidTransform& pose) const {
    return DrawPrint(camera_, pattern_, print, pose);
  }
  // Returns the image with less light where 'shadow' is true in the plane of 'pose'.
  cv::Mat Shade(const cv::Mat& image, const RigidTransform& pose,
                const std::function<bool(double, double)>& shadow) const {
    constexpr double kLight = 0.45;
    cv::Mat shaded = image.clone();
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        Eigen::Vector3d ray;
        camera_.Unproject({static_cast<double>(u), static_cast<double>(v)}, &ray);
        const Eigen::Vector3d point = PlaneFromRay(pose) * ray;
        if (!shadow(point.x() / point.z(), point.y() / point.z())) continue;
        auto& gray = shaded.at<std::uint8_t>(v, u);
        gray = static_cast<std::uint8_t>(kLight * gray);
      }
    }
    return shaded;
  }

  const LandingPattern pattern_{};
  const CameraModel camera_ = TestPrintCamera();
  const RayTable rays_{camera_};
  const SmallPatternFitter fitter_{camera_, rays_, pattern_};
  SmallPatternWorkspace workspace_;
};

TEST_F(SmallPatternTest, LocatesRingsOf13To28Pixels) {
  Random random(1);
  for (int diameter_px = 13; diameter_px <= 28; ++diameter_px) {
    const RigidTransform truth = PoseOf(diameter_px, &random);
    const cv::Mat image = AddNoise(Draw(SpokedPrint(pattern_, 4), truth), 2, &random);
    const auto fit = Fit(image, truth);
    ASSERT_TRUE(fit) << diameter_px;
    const Eigen::Vector3d& found = fit->location.camera_from_target.translation;
    const double distance = truth.translation.norm();
    EXPECT_LT((found / found.norm() - truth.translation / distance).norm() * 220, 0.15)
        << "pixels, ring of " << diameter_px;
    EXPECT_NEAR(found.norm() / distance, 1, 0.02) << diameter_px;
    EXPECT_GT(fit->correlation, 0.95) << diameter_px;
    EXPECT_GT(Agreement(*fit), 0.75) << diameter_px;
    const double arm = PoseError(fit->location.camera_from_target, truth)
                           .tail<3>()
                           .dot(truth.rotation * Eigen::Vector3d::UnitZ());
    EXPECT_LT(std::abs(arm), 0.1) << diameter_px;
  }
}

TEST_F(SmallPatternTest, OtherFiguresInRingFitWorse) {
  Random random(2);
  const Print empty = [this](double x, double y) { return IsRing(pattern_, x, y); };
  for (const int diameter_px : {16, 20, 24, 28}) {
    const RigidTransform truth = PoseOf(diameter_px, &random);
    for (const Print& print : {SpokedPrint(pattern_, 2), SpokedPrint(pattern_, 3),
                               SpokedPrint(pattern_, 5), SpokedPrint(pattern_, 8), empty}) {
      const auto fit = Fit(Draw(print, truth), truth);
      EXPECT_LT(fit ? std::min(LeastPart(*fit), fit->cross_correlation) : 0, 0.75) << diameter_px;
    }
  }
}

TEST_F(SmallPatternTest, CovarianceMatchesErrors) {
  struct Case {
    double noise;         // gray values
    double lowest_ratio;  // ratio of errors to standard deviations
  };
  // With little noise the error of the model, which the covariance includes, is the larger part.
  for (const Case& one : {Case{6, 1. / 3}, Case{20, 0.8}}) {
    const Eigen::Vector3d ratios = RatiosOfErrors(one.noise);
    EXPECT_GT(ratios.minCoeff(), one.lowest_ratio) << one.noise;
    EXPECT_LT(ratios.maxCoeff(), 1.25) << one.noise;
  }
}

TEST_F(SmallPatternTest, OverexposureDoesNotMovePose) {
  Random random(4);
  const RigidTransform truth = PoseOf(24, &random);
  cv::Mat image = Draw(SpokedPrint(pattern_, 4), truth);
  image.convertTo(image, CV_8UC1, 1.9, 0);  // white at 380, saturated
  const auto fit = Fit(image, truth);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->location.camera_from_target.translation.norm() / truth.translation.norm(), 1,
              0.03);
}

TEST_F(SmallPatternTest, FlatImageFitsNothing) {
  const RigidTransform pose = PrintPose({0, 0, 10}, 0, 0, 0);
  EXPECT_FALSE(fitter_.Refine(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)), pose, Light::kEven, 8,
                              &workspace_));
}

TEST_F(SmallPatternTest, OtherSignsRaiseDoubts) {
  Random random(4);
  const auto others = [&](const Print& print, const RigidTransform& pose) {
    return FitInPlace(Draw(print, pose), pose, Light::kEven);
  };
  const double outer = pattern_.outer_radius_m();
  const Print frame = [&](double x, double y) {
    const double sum = std::abs(x) + std::abs(y);  // corners at the ends of the arms
    return (sum > 1.0 * outer && sum < 1.25 * outer) || SpokedPrint(pattern_, 4)(x, y);
  };
  const Print blot = [&](double x, double y) { return std::hypot(x, y) < outer; };
  for (const int diameter_px : {16, 22, 28, 50}) {
    const RigidTransform pose = PoseOf(diameter_px, &random);
    const auto right = others(SpokedPrint(pattern_, 4), pose);
    ASSERT_TRUE(right) << diameter_px;
    EXPECT_LT(std::abs(right->frame_corners), 0.05) << diameter_px;
    EXPECT_GT(right->cross_correlation, 0.9) << diameter_px;
    EXPECT_GT(others(frame, pose)->frame_corners, 0.1) << diameter_px;
    EXPECT_LT(others(blot, pose)->cross_correlation, 0.5) << diameter_px;
  }
}

// Shadows of a straight edge, and of the body and the four rotors of a UAV.
TEST_F(SmallPatternTest, RemovesShadows) {
  Random random(6);
  const auto edge = [](double x, double y) { return 0.6 * x + 0.8 * y > 0.1; };
  const auto uav = [](double x, double y) {
    const auto disc = [&](double cx, double cy, double radius) {
      return std::hypot(x - cx, y - cy) < radius;
    };
    return disc(0.2, 0, 0.15) || disc(-0.1, 0.2, 0.14) || disc(-0.1, -0.2, 0.14) ||
           disc(0.5, 0.2, 0.14) || disc(0.5, -0.2, 0.14);
  };
  for (const bool is_edge : {true, false}) {
    const auto shadow = is_edge ? std::function<bool(double, double)>(edge) : uav;
    for (const int diameter_px : {20, 24, 28, 40}) {
      const double distance = 220.0 / diameter_px;
      const RigidTransform truth =
          PrintPose({0.1 * distance, -0.05 * distance, distance}, 0.2, 1, 0.04 * diameter_px);
      const cv::Mat even = Draw(SpokedPrint(pattern_, 4), truth);
      const cv::Mat shaded = AddNoise(Shade(even, truth, shadow), 1.5, &random);
      const auto evened = FitInPlace(shaded, truth, Light::kShadows);
      ASSERT_TRUE(evened) << diameter_px;
      EXPECT_GT(evened->cross_correlation, 0.85) << diameter_px;
      const auto fit = fitter_.Refine(shaded, truth, Light::kShadows, 8, &workspace_);
      ASSERT_TRUE(fit) << diameter_px;
      EXPECT_GT(fit->correlation, 0.93) << diameter_px;
      EXPECT_GT(Agreement(*fit), 0.85) << diameter_px;
      EXPECT_FALSE(FitInPlace(even, truth, Light::kShadows)) << "there are none";
      // A straight edge through the print is nearly a slope of the light, which every fit includes.
      if (is_edge) continue;
      const auto lit = FitInPlace(shaded, truth, Light::kEven);
      EXPECT_GT(evened->cross_correlation, (lit ? lit->cross_correlation : 0) + 0.05)
          << diameter_px;
    }
  }
}

// The lines of other signs are as narrow as those of the print, so no shadows explain them.
TEST_F(SmallPatternTest, ShadowsDoNotExplainOtherSigns) {
  Random random(9);
  const Print frame = [](double x, double y) {
    const double reach = std::max(std::abs(x + y), std::abs(x - y)) / std::numbers::sqrt2;
    return std::abs(reach - 0.45) < 0.05 || IsSpoke(x, y, 4, 0.05, 0.6);
  };
  for (const int diameter_px : {18, 24, 28, 40}) {
    const RigidTransform truth = PoseOf(diameter_px, &random);
    for (const Print& print : {SpokedPrint(pattern_, 8), SpokedPrint(pattern_, 6), frame}) {
      const cv::Mat image = AddNoise(Draw(print, truth), 1.5, &random);
      EXPECT_FALSE(FitInPlace(image, truth, Light::kShadows)) << diameter_px;
    }
  }
}

TEST_F(SmallPatternTest, DoesNotExplainNoise) {
  Random random(7);
  double most = 0;
  for (int i = 0; i < 40; ++i) {
    const cv::Mat noise = AddNoise(cv::Mat(240, 320, CV_8UC1, cv::Scalar(120)), 25, &random);
    const auto fit = Fit(noise, PoseOf(13, &random));
    if (fit) most = std::max(most, fit->explained);
  }
  EXPECT_LT(most, 0.5);
  const RigidTransform truth = PoseOf(13, &random);
  const auto fit = Fit(Draw(SpokedPrint(pattern_, 4), truth), truth);
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->explained, 0.8);
}

TEST_F(SmallPatternTest, HighlightDoesNotSpoilFit) {
  Random random(5);
  for (const int diameter_px : {18, 24}) {
    const RigidTransform truth = PoseOf(diameter_px, &random);
    cv::Mat image = AddNoise(Draw(SpokedPrint(pattern_, 4), truth), 2, &random);
    Eigen::Vector2d spot;
    camera_.Project(truth * Eigen::Vector3d(0.55, 0.1, 0), &spot);
    image(cv::Rect(static_cast<int>(spot.x()) - 1, static_cast<int>(spot.y()) - 1, 3, 3)) = 254;
    const auto fit = Fit(image, truth);
    ASSERT_TRUE(fit) << diameter_px;
    const double distance = truth.translation.norm();
    EXPECT_NEAR(fit->location.camera_from_target.translation.norm() / distance, 1, 0.02)
        << diameter_px;
  }
}

TEST_F(SmallPatternTest, HighlightInQuadrantRaisesNoDoubt) {
  Random random(6);
  for (const int diameter_px : {18, 24}) {
    const RigidTransform truth = PoseOf(diameter_px, &random);
    // Half as bright, so that the image does not saturate in the highlight.
    cv::Mat image = 0.5 * AddNoise(Draw(SpokedPrint(pattern_, 4), truth), 2, &random);
    Eigen::Vector2d spot;
    camera_.Project(truth * Eigen::Vector3d(0.2, 0.2, 0), &spot);
    const auto x = static_cast<int>(std::lround(spot.x()));
    const auto y = static_cast<int>(std::lround(spot.y()));
    image(cv::Rect(x - 1, y - 1, 3, 3)) = 240;  // where white is 100
    const auto fit = Fit(image, truth);
    ASSERT_TRUE(fit) << diameter_px;
    EXPECT_GT(fit->cross_correlation, 0.93) << diameter_px;
    EXPECT_GT(fit->explained, 0.9) << diameter_px;
  }
}

TEST_F(SmallPatternTest, ArmInHighlightIsNotMissing) {
  Random random(7);
  const RigidTransform truth = PoseOf(24, &random);
  const cv::Mat image = 0.4 * AddNoise(Draw(SpokedPrint(pattern_, 4), truth), 2, &random);
  Eigen::Vector2d spot;
  camera_.Project(truth * Eigen::Vector3d(0.22, 0, 0), &spot);
  cv::Mat lit = image.clone();
  for (int v = 0; v < lit.rows; ++v) {
    for (int u = 0; u < lit.cols; ++u) {
      const double away = (Eigen::Vector2d(u, v) - spot).squaredNorm() / (2.5 * 2.5);
      auto& gray = lit.at<std::uint8_t>(v, u);
      gray = cv::saturate_cast<std::uint8_t>(gray + 120 * std::exp(-0.5 * away));
    }
  }
  const auto fit = Fit(lit, truth);
  ASSERT_TRUE(fit);
  EXPECT_EQ(std::count_if(fit->shares.arm.begin(), fit->shares.arm.end(),
                          [](double share) { return share < 0; }),
            1);
  EXPECT_GT(Agreement(*fit), 0.8);
}

// Noise that is uncorrelated between pixels does not lower the correlation, however strong it is.
TEST_F(SmallPatternTest, RemovesNoiseFromCorrelation) {
  Random random(10);
  const RigidTransform truth = PoseOf(26, &random);
  const cv::Mat clean = Draw(SpokedPrint(pattern_, 4), truth);
  for (const double sigma : {5.0, 15.0, 25.0}) {
    double least = 1;
    for (int i = 0; i < 10; ++i) {
      const auto fit = FitInPlace(AddNoise(clean, sigma, &random), truth, Light::kEven);
      ASSERT_TRUE(fit) << sigma;
      least = std::min(least, fit->correlation);
    }
    EXPECT_GT(least, 0.97) << sigma;
  }
}

}  // namespace
}  // namespace kestrel
