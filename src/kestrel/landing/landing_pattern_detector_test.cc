// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/landing_pattern_detector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/base/error.h"
#include "kestrel/landing/search_plan.h"
#include "kestrel/landing/test_prints.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

class LandingPatternDetectorTest : public ::testing::Test {
 protected:
  cv::Mat Draw(const Print& print, const RigidTransform& pose) const {
    return DrawPrint(camera_, pattern_, print, pose);
  }
  LandingReport Detect(const cv::Mat& image, const LandingHint& hint = {}) {
    return detector_.Detect(image, hint, workspace_);
  }

  const LandingPattern pattern_{};
  const CameraModel camera_ = TestPrintCamera();
  const LandingPatternDetector detector_{camera_, {}};
  LandingWorkspace workspace_;
  const RigidTransform pose_ = PrintPose({0.15, -0.1, 3}, 0.25, 1, 0.3);
  const cv::Mat image_ = DrawPrint(camera_, pattern_, SpokedPrint(pattern_, 4), pose_);
};

// A ring of 24 px whose centre moves over the left image border: half of it is in view at 0.
TEST_F(LandingPatternDetectorTest, FindsSmallPatternsThatTheImageBorderCutsOff) {
  for (const double center_px : {8.0, 4.0, 0.0}) {
    const double distance = 9;
    const RigidTransform truth =
        PrintPose({(center_px - 159.5) / 220 * distance, 0.4, distance}, 0.1, 2, 0.5);
    const LandingReport report = Detect(Draw(SpokedPrint(pattern_, 4), truth));
    ASSERT_TRUE(report.detection) << center_px << " px: " << report.reason;
    Eigen::Vector2d center;
    camera_.Project(truth.translation, &center);
    EXPECT_LT((report.detection->center_px - center).norm(), 0.5) << center_px;
  }
}

// Rings of 25 x 7 to 13 px under the shadow of something long: its edges tear their outlines.
TEST_F(LandingPatternDetectorTest, FindsFlatPatternsUnderShadows) {
  constexpr int kImages = 100;
  Random random(11);
  int found = 0;
  for (int i = 0; i < kImages; ++i) {
    const double tilt = random.Uniform(1, 1.25), axis = random.Uniform(0, 6);
    const RigidTransform truth = PrintPose({0.15, -0.1, 9}, tilt, axis, random.Uniform(0, 6));
    Eigen::Vector2d center;
    camera_.Project(truth.translation, &center);
    const double direction = random.Uniform(0, 6);
    const Eigen::Vector2d across(std::cos(direction), std::sin(direction));
    const double middle_px = across.dot(center) + random.Uniform(-8, 8);
    const double half_width_px = random.Uniform(3, 12);
    cv::Mat image = Draw(SpokedPrint(pattern_, 4), truth);
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        if (std::abs(across.dot(Eigen::Vector2d(u, v)) - middle_px) > half_width_px) continue;
        std::uint8_t& gray = image.at<std::uint8_t>(v, u);
        gray = static_cast<std::uint8_t>(std::lround(0.4 * gray));
      }
    }
    cv::GaussianBlur(image, image, {}, 0.6);
    const LandingReport report = Detect(AddNoise(image, 2, &random));
    if (!report.detection) continue;
    ++found;
    EXPECT_LT((report.detection->center_px - center).norm(), 0.8) << i;
  }
  EXPECT_GE(found, 86);
}

// Where about a quarter is in view, a wrong pose may agree with the print at full quality: its
// edges hardly hold it, and the search goes on to the right one. Of 300 it was 1 and 5, in two
// draws.
TEST_F(LandingPatternDetectorTest, PutsPrintsThatAreCutOffWhereTheyAre) {
  constexpr int kImages = 300;
  Random random(3);
  int found = 0, wrong = 0;
  for (int i = 0; i < kImages; ++i) {
    const double distance = random.Uniform(1, 2);
    const double center_px = random.Uniform(-50, -10);
    const double tilt_axis = random.Uniform(0, 6);
    const double yaw = random.Uniform(0, 6);
    const RigidTransform truth =
        PrintPose({(center_px - 159.5) / 220 * distance, 0, distance}, 0.4, tilt_axis, yaw);
    const LandingReport report =
        Detect(AddNoise(Draw(SpokedPrint(pattern_, 4), truth), 8, &random));
    if (!report.detection) continue;
    ++found;
    const Eigen::Vector3d& position = report.detection->camera_from_pattern.translation;
    wrong += (position - truth.translation).norm() > 0.02;
  }
  EXPECT_GT(found, kImages / 2);
  EXPECT_LE(wrong, kImages / 50);
}

TEST_F(LandingPatternDetectorTest, AnImageThatContradictsWhatIsUpPrevails) {
  LandingHint hint;
  const Eigen::Vector3d normal = pose_.rotation * Eigen::Vector3d::UnitZ();
  hint.up_in_camera = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()) * normal;  // 23 degrees off
  const LandingReport report = Detect(image_, hint);
  ASSERT_TRUE(report.detection) << report.reason;
  EXPECT_LT(PoseError(report.detection->camera_from_pattern, pose_).head<3>().norm(), 0.015);
}

// What two reports of one image must share: all but the times.
void ExpectSame(const LandingReport& a, const LandingReport& b) {
  EXPECT_EQ(a.reached, b.reached);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.candidates, b.candidates);
  ASSERT_EQ(a.detection.has_value(), b.detection.has_value());
  if (!a.detection) return;
  EXPECT_EQ(a.detection->center_px, b.detection->center_px);
  EXPECT_EQ(a.detection->camera_from_pattern.translation,
            b.detection->camera_from_pattern.translation);
  EXPECT_EQ(a.detection->covariance, b.detection->covariance);
  EXPECT_EQ(a.detection->quality, b.detection->quality);
  EXPECT_EQ(a.detection->method, b.detection->method);
}

TEST_F(LandingPatternDetectorTest, FindsThePatternAtAllSizes) {
  struct Case {
    double distance;
    CrossMethod method;
  };
  for (const Case& c : {Case{1.1, CrossMethod::kLines}, Case{3, CrossMethod::kThinning},
                        Case{9, CrossMethod::kQuadrants}}) {
    const RigidTransform truth =
        PrintPose({0.03 * c.distance, 0.02 * c.distance, c.distance}, 0.1, 2, 0.5);
    const LandingReport report = Detect(Draw(SpokedPrint(pattern_, 4), truth));
    ASSERT_TRUE(report.detection) << c.distance << " m: " << report.reason;
    EXPECT_EQ(report.reached, LandingStage::kFound);
    EXPECT_EQ(report.reason, "");
    const LandingDetection& detection = *report.detection;
    EXPECT_EQ(detection.method, c.method) << ToString(detection.method);
    EXPECT_LT(PoseError(detection.camera_from_pattern, truth).head<3>().norm(), 0.02 * c.distance);
    Eigen::Vector2d center;
    camera_.Project(truth.translation, &center);
    EXPECT_LT((detection.center_px - center).norm(), 0.2);
    EXPECT_NEAR(detection.ring_semi_major_px, 110 / c.distance, 0.08 * 110 / c.distance + 0.7);
    EXPECT_GT(detection.quality, 0.8);
    EXPECT_LE(detection.quality, 1);
  }
}

TEST_F(LandingPatternDetectorTest, OtherSignsAreNotThePattern) {
  const Print empty = [this](double x, double y) { return IsRing(pattern_, x, y); };
  const Print cross_only = [this](double x, double y) {
    return IsSpoke(x, y, 4, 0.05, pattern_.arm_half_length_m);
  };
  const Print off_center = [this](double x, double y) {
    return IsRing(pattern_, x, y) ||
           (std::hypot(x, y) < 0.4 && IsSpoke(x - 0.2, y, 4, 0.05, pattern_.arm_half_length_m));
  };
  const std::vector<Print> signs{SpokedPrint(pattern_, 2),
                                 SpokedPrint(pattern_, 3),
                                 SpokedPrint(pattern_, 5),
                                 SpokedPrint(pattern_, 6),
                                 SpokedPrint(pattern_, 8),
                                 empty,
                                 cross_only,
                                 off_center};
  for (const double distance : {1.4, 3.0, 6.0, 9.0}) {
    for (std::size_t i = 0; i < signs.size(); ++i) {
      const RigidTransform pose = PrintPose({0.1, 0.05, distance}, 0.2, 1, 0.4);
      // Higher than a cross alone is looked for.
      LandingHint hint;
      hint.altitude_m = std::max(distance, 3.0);
      const LandingReport report = Detect(Draw(signs[i], pose), hint);
      EXPECT_FALSE(report.detection) << "sign " << i << " at " << distance << " m";
      EXPECT_NE(report.reason, "");
      // Nor where one was predicted.
      hint.center_in_camera = pose.translation;
      hint.up_in_camera = pose.rotation * Eigen::Vector3d::UnitZ();
      EXPECT_FALSE(Detect(Draw(signs[i], pose), hint).detection)
          << "predicted sign " << i << " at " << distance << " m";
    }
  }
}

// Rings of 44 px that are 6 to 15 px high and blurred: too few pixels across to tell every letter
// from a cross at sight.
TEST_F(LandingPatternDetectorTest, LettersInFlatRingsAreNotThePattern) {
  constexpr int kImages = 150;
  Random random(12);
  int found = 0;
  for (int i = 0; i < kImages; ++i) {
    const double tilt = random.Uniform(1.22, 1.43), axis = random.Uniform(0, 6);
    const RigidTransform pose = PrintPose({0.15, -0.1, 5}, tilt, axis, random.Uniform(0, 6));
    const double side = random.Uniform(0.12, 0.2), bar = random.Uniform(0.03, 0.055);
    const auto letter_h = [=](double x, double y) {
      return std::max(std::abs(x), std::abs(y)) < side + bar &&
             (std::abs(std::abs(x) - side) < bar || std::abs(y) < bar);
    };
    const auto letter_t = [=](double x, double y) {
      return std::abs(y) < bar || (std::abs(x) < bar && y > 0);
    };
    const bool is_h = random.Chance(0.5);
    const Print sign = [&](double x, double y) {
      return IsRing(pattern_, x, y) || (std::hypot(x, y) < pattern_.outer_radius_m() &&
                                        (is_h ? letter_h(x, y) : letter_t(x, y)));
    };
    cv::Mat image = Draw(sign, pose);
    cv::GaussianBlur(image, image, {}, random.Uniform(0.4, 1.0));
    found += Detect(AddNoise(image, 2, &random)).detection.has_value();
  }
  EXPECT_LE(found, 1);
}

TEST_F(LandingPatternDetectorTest, AHintFitsAPatternThatFillsTheImageOfAFisheye) {
  // Half a metre above the board the ring spans 90 degrees: much less than its size over its
  // distance times the focal length.
  const CameraModel fisheye(
      {752, 480, 250, 250, 375.5, 239.5, DistortionModel::kEquidistant, {0, 0, 0, 0}});
  const LandingPatternDetector detector(fisheye, {});
  for (const double distance : {0.45, 0.6, 1.0}) {
    const RigidTransform truth = PrintPose({0.02, 0.03, distance}, 0.1, 1, 0.3);
    const cv::Mat image = DrawPrint(fisheye, pattern_, SpokedPrint(pattern_, 4), truth);
    LandingHint hint;
    hint.center_in_camera = truth.translation;
    hint.center_sigma_m = 0.1;
    hint.altitude_m = distance + 2;  // above the ground, not above the roof
    const LandingReport report = detector.Detect(image, hint, workspace_);
    ASSERT_TRUE(report.detection) << distance << " m: " << report.reason;
    EXPECT_LT(PoseError(report.detection->camera_from_pattern, truth).head<3>().norm(), 0.005);
  }
}

TEST_F(LandingPatternDetectorTest, TheSizeOfARingIsThatOfItsImage) {
  // 85 degrees from the axis the lens stretches what it shows by half, along its rim.
  const CameraModel fisheye(
      {752, 752, 230, 230, 375.5, 375.5, DistortionModel::kEquidistant, {0, 0, 0, 0}});
  const LandingPatternDetector detector(fisheye, {});
  const double angle = 85 * std::numbers::pi / 180;
  const Eigen::Vector3d direction(std::sin(angle), 0, std::cos(angle));
  RigidTransform truth;
  truth.rotation = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), -direction);
  truth.translation = 3 * direction;
  const cv::Mat image = DrawPrint(fisheye, pattern_, SpokedPrint(pattern_, 4), truth);
  const LandingReport report = detector.Detect(image, {}, workspace_);
  ASSERT_TRUE(report.detection) << report.reason;
  const double by_angle = 230 * std::atan2(pattern_.outer_radius_m(), 3);
  EXPECT_NEAR(report.detection->ring_semi_minor_px, by_angle, 0.03 * by_angle);
  EXPECT_NEAR(report.detection->ring_semi_major_px, angle / std::sin(angle) * by_angle,
              0.03 * by_angle);
}

TEST_F(LandingPatternDetectorTest, AFlatImageFallsAtTheFirstStages) {
  const LandingReport report = Detect(cv::Mat(240, 320, CV_8UC1, cv::Scalar(100)));
  EXPECT_FALSE(report.detection);
  EXPECT_EQ(report.reached, LandingStage::kBinarize);
  EXPECT_EQ(report.candidates[static_cast<int>(LandingStage::kRing)], 0);
}

TEST_F(LandingPatternDetectorTest, AnImageThatIsNotTheCamerasIsAnswered) {
  for (const cv::Mat& image : {cv::Mat(240, 320, CV_8UC3), cv::Mat(240, 319, CV_8UC1),
                               cv::Mat(240, 320, CV_16UC1), cv::Mat()}) {
    const LandingReport report = Detect(image);
    EXPECT_FALSE(report.detection);
    EXPECT_EQ(report.reached, LandingStage::kBinarize);
    EXPECT_THAT(std::string(report.reason), HasSubstr("not 8-bit gray"));
  }
}

TEST_F(LandingPatternDetectorTest, SameImageSameReport) {
  const LandingReport first = Detect(image_);
  ASSERT_TRUE(first.detection);
  // Whatever the workspace saw in between.
  Random random(1);
  Detect(AddNoise(image_, 60, &random));
  Detect(cv::Mat(240, 320, CV_8UC1, cv::Scalar(0)));
  ExpectSame(Detect(image_), first);
  LandingWorkspace fresh;
  ExpectSame(detector_.Detect(image_, {}, fresh), first);
}

TEST_F(LandingPatternDetectorTest, ThreadsShareADetector) {
  std::vector<cv::Mat> images;
  Random random(2);
  for (int i = 0; i < 8; ++i) {
    images.push_back(AddNoise(Draw(SpokedPrint(pattern_, i % 4 == 3 ? 3 : 4),
                                   PrintPose({0.1 * i - 0.4, 0.1, 1.5 + 0.7 * i}, 0.1, i, 0.2 * i)),
                              3, &random));
  }
  std::array<std::vector<LandingReport>, 3> reports;
  const auto run = [&](std::vector<LandingReport>* into) {
    LandingWorkspace workspace;
    for (int round = 0; round < 3; ++round) {
      for (const cv::Mat& image : images) {
        into->push_back(detector_.Detect(image, {}, workspace));
      }
    }
  };
  run(&reports[0]);
  std::thread one(run, &reports[1]), two(run, &reports[2]);
  one.join();
  two.join();
  for (std::size_t i = 0; i < reports[0].size(); ++i) {
    ExpectSame(reports[1][i], reports[0][i]);
    ExpectSame(reports[2][i], reports[0][i]);
  }
}

// Two patterns side by side: the one that was expected is taken.
TEST_F(LandingPatternDetectorTest, AHintSaysWhereToLook) {
  const RigidTransform left = PrintPose({-1.1, 0.1, 4}, 0.1, 1, 0.3);
  const RigidTransform right = PrintPose({1.1, -0.1, 4}, 0.1, 1, 0.6);
  cv::Mat image = Draw(SpokedPrint(pattern_, 4), left);
  const cv::Rect half(image.cols / 2, 0, image.cols / 2, image.rows);
  Draw(SpokedPrint(pattern_, 4), right)(half).copyTo(image(half));
  for (const RigidTransform& pose : {left, right}) {
    LandingHint hint;
    hint.center_in_camera = pose.translation + Eigen::Vector3d(0.05, 0.05, 0.1);
    hint.center_sigma_m = 0.1;
    const LandingReport report = Detect(image, hint);
    ASSERT_TRUE(report.detection) << report.reason;
    EXPECT_LT((report.detection->camera_from_pattern.translation - pose.translation).norm(), 0.05);
  }
}

// What is told may be wrong in any way: a pattern in plain view is found, and where it is.
TEST_F(LandingPatternDetectorTest, AWrongHintHidesNothing) {
  struct Told {
    const char* what;
    LandingHint hint;
  };
  const auto center = [](const Eigen::Vector3d& at) {
    LandingHint hint;
    hint.center_in_camera = at;
    hint.center_sigma_m = 0.1;
    return hint;
  };
  const auto altitude = [](double altitude_m) {
    LandingHint hint;
    hint.altitude_m = altitude_m;
    return hint;
  };
  const auto up = [](const Eigen::Vector3d& in_camera) {
    LandingHint hint;
    hint.up_in_camera = in_camera;
    return hint;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double distance : {1.1, 3.0, 9.0}) {
    const RigidTransform truth =
        PrintPose({0.05 * distance, -0.03 * distance, distance}, 0.25, 1, 0.3);
    const Eigen::Vector3d& at = truth.translation;
    const Eigen::Vector3d normal = truth.rotation * Eigen::Vector3d::UnitZ();
    Eigen::Vector3d turned_round = normal;
    turned_round.head<2>() *= -1;
    LandingHint all_wrong = center({-0.5 * distance, 0.1, 2 * distance});
    all_wrong.up_in_camera = -normal;
    all_wrong.altitude_m = distance + 500;
    const Told wrong[] = {
        {"altitude + 10 m", altitude(distance + 10)},
        {"altitude + 500 m", altitude(distance + 500)},
        {"altitude x 3", altitude(3 * distance)},
        {"altitude negative", altitude(-20)},
        {"altitude not a number", altitude(kNan)},
        {"upside down", up(-normal)},
        {"turned round", up(turned_round)},
        {"on edge", up(normal.unitOrthogonal())},
        {"track beside it", center(at + Eigen::Vector3d(0.5 * distance, 0, 0))},
        {"track out of the image", center({10 * distance, 0, distance})},
        {"track behind the camera", center(-at)},
        {"track three times as far", center(3 * at)},
        {"track at a third", center(at / 3)},
        {"track not a number", center({kNan, 0, 1})},
        {"all of it", all_wrong},
    };
    const cv::Mat image = Draw(SpokedPrint(pattern_, 4), truth);
    Eigen::Vector2d center_px;
    camera_.Project(at, &center_px);
    for (const Told& told : wrong) {
      const LandingReport report = Detect(image, told.hint);
      ASSERT_TRUE(report.detection) << told.what << " at " << distance << " m: " << report.reason;
      EXPECT_LT((report.detection->center_px - center_px).norm(), 0.2)
          << told.what << " at " << distance << " m";
      // Where what is up is wrong the pose of the two may be that tells it better.
      EXPECT_LT((report.detection->camera_from_pattern.translation - at).norm(), 0.1 * distance)
          << told.what << " at " << distance << " m";
    }
  }
}

TEST_F(LandingPatternDetectorTest, AGoodPredictionNeedsNoSearch) {
  constexpr auto kAreas = static_cast<int>(LandingStage::kAreas);
  for (const double distance : {1.1, 3.0, 6.0, 9.0}) {
    const RigidTransform truth =
        PrintPose({0.03 * distance, 0.02 * distance, distance}, 0.1, 2, 0.5);
    const cv::Mat image = Draw(SpokedPrint(pattern_, 4), truth);
    LandingHint hint;
    hint.up_in_camera = truth.rotation * Eigen::Vector3d::UnitZ();
    const LandingReport searched = Detect(image, hint);
    ASSERT_TRUE(searched.detection);
    EXPECT_GT(searched.candidates[kAreas], 0);
    hint.center_in_camera = truth.translation + Eigen::Vector3d(0.03, -0.02, 0.02 * distance);
    const LandingReport predicted = Detect(image, hint);
    ASSERT_TRUE(predicted.detection);
    EXPECT_EQ(predicted.candidates[kAreas], 0) << distance << " m";
    EXPECT_EQ(predicted.detection->method, searched.detection->method);
    EXPECT_LT((predicted.detection->center_px - searched.detection->center_px).norm(), 0.05);
    EXPECT_LT((predicted.detection->camera_from_pattern.translation -
               searched.detection->camera_from_pattern.translation)
                  .norm(),
              0.002 * distance);
    // Half a ring off: within three sigma, found by search.
    hint.center_in_camera = truth.translation + Eigen::Vector3d(0.3, -0.2, 0);
    hint.center_sigma_m = 0.2;
    const LandingReport around = Detect(image, hint);
    ASSERT_TRUE(around.detection);
    EXPECT_GT(around.candidates[kAreas], 0);
  }
}

TEST_F(LandingPatternDetectorTest, TheQualityIsThatOfTheImageWhateverIsTold) {
  LandingHint hint;
  hint.altitude_m = 3;
  const LandingReport right = Detect(image_, hint);
  hint.altitude_m = 9;
  const LandingReport wrong = Detect(image_, hint);
  ASSERT_TRUE(right.detection && wrong.detection);
  EXPECT_EQ(right.detection->quality, Detect(image_).detection->quality);
  EXPECT_EQ(wrong.detection->quality, right.detection->quality);
}

// An image whose pattern a late step finds, searched by little and little: every frame goes on
// where the one before stopped.
TEST_F(LandingPatternDetectorTest, ASearchThatIsOutOfTimeGoesOnInTheNextFrame) {
  LandingPatternDetectorOptions options;
  options.max_search_ms = 1e-6;  // one step a frame
  const LandingPatternDetector bounded(camera_, options);
  const RigidTransform truth = PrintPose({0.3, -0.2, 12}, 0.2, 1, 0.3);
  const cv::Mat image = Draw(SpokedPrint(pattern_, 4), truth);
  LandingHint hint;
  int frames = 0;
  for (;; ++frames) {
    ASSERT_LT(frames, static_cast<int>(kSearchSteps));
    const LandingReport report = bounded.Detect(image, hint, workspace_);
    if (report.detection) {
      EXPECT_EQ(report.next_step, 0);
      EXPECT_LT((report.detection->camera_from_pattern.translation - truth.translation).norm(),
                0.03 * truth.translation.norm());
      break;
    }
    EXPECT_GT(report.next_step, hint.first_step);
    hint.first_step = report.next_step;
  }
  EXPECT_GT(frames, 1) << "the first steps look for larger rings";
}

TEST_F(LandingPatternDetectorTest, ABoundedSearchOfAnEmptyImageTakesEveryStepInTurn) {
  LandingPatternDetectorOptions options;
  options.max_search_ms = 1e-6;
  const LandingPatternDetector bounded(camera_, options);
  const cv::Mat image = Draw(SpokedPrint(pattern_, 3), pose_);
  for (const bool is_told : {false, true}) {
    LandingHint hint;
    if (is_told) hint.center_in_camera = pose_.translation;
    std::set<int> steps;
    for (int frame = 0; frame < 2 * static_cast<int>(kSearchSteps); ++frame) {
      const LandingReport report = bounded.Detect(image, hint, workspace_);
      EXPECT_FALSE(report.detection);
      steps.insert(report.next_step);
      hint.first_step = report.next_step;
    }
    // Where nothing is told, the likely part is the whole image: one round.
    EXPECT_GE(steps.size(), kSearchSteps);
    EXPECT_TRUE(steps.contains(0) || steps.contains(static_cast<int>(kSearchSteps)));
    EXPECT_TRUE(std::all_of(steps.begin(), steps.end(), [](int step) {
      return step >= 0 && step < 2 * static_cast<int>(kSearchSteps);
    }));
  }
}

TEST_F(LandingPatternDetectorTest, WithoutABoundEverySearchIsWhole) {
  LandingPatternDetectorOptions options;
  options.max_search_ms = 1e9;
  const LandingPatternDetector generous(camera_, options);
  const cv::Mat far = Draw(SpokedPrint(pattern_, 4), PrintPose({0.3, -0.2, 9}, 0.2, 1, 0.3));
  const cv::Mat other = Draw(SpokedPrint(pattern_, 3), pose_);
  for (const cv::Mat& image : {image_, far, other}) {
    const LandingReport whole = Detect(image);
    EXPECT_EQ(whole.next_step, 0);
    ExpectSame(generous.Detect(image, {}, workspace_), whole);
    for (const int first_step : {1, 7, 23, 30, -5, 1000}) {
      LandingHint hint;
      hint.first_step = first_step;
      const LandingReport report = Detect(image, hint);
      EXPECT_EQ(report.detection.has_value(), whole.detection.has_value()) << first_step;
      EXPECT_EQ(report.next_step, 0) << first_step;
    }
  }
}

// Stricter users get less, none of it improbable.
TEST_F(LandingPatternDetectorTest, TheQualityThatIsAskedForIsKept) {
  const double quality = Detect(image_).detection->quality;
  for (const double least : {0.0, 0.3, 0.9, 1.0}) {
    LandingPatternDetectorOptions options;
    options.min_quality = least;
    const LandingReport report =
        LandingPatternDetector(camera_, options).Detect(image_, {}, workspace_);
    ASSERT_EQ(report.detection.has_value(), quality >= least) << least;
    EXPECT_GE(report.detection ? report.detection->quality : 1, least);
  }
}

TEST_F(LandingPatternDetectorTest, TheAttitudeResolvesTheMirrorPose) {
  Random random(3);
  for (int trial = 0; trial < 6; ++trial) {
    const RigidTransform truth =
        PrintPose({0.2, 0.1, 7}, 0.5, random.Uniform(0, 6), random.Uniform(0, 6));
    const Eigen::Vector3d up = truth.rotation * Eigen::Vector3d::UnitZ();
    LandingHint hint;
    hint.up_in_camera = up;
    const LandingReport report =
        Detect(AddNoise(Draw(SpokedPrint(pattern_, 4), truth), 2, &random), hint);
    ASSERT_TRUE(report.detection) << trial << ": " << report.reason;
    const Eigen::Vector3d found =
        report.detection->camera_from_pattern.rotation * Eigen::Vector3d::UnitZ();
    EXPECT_GT(found.dot(up), 0.95) << trial;
  }
}

// Far prints are as alike under both poses of their ring as their noise: which is reported is
// mostly the right one, and the covariance knows of the other.
TEST_F(LandingPatternDetectorTest, TheCovarianceKnowsOfTheMirrorPose) {
  Random random(11);
  int mirrored = 0, wrong = 0;
  for (int i = 0; i < 60; ++i) {
    const double distance = random.Uniform(7, 11);
    const RigidTransform truth = PrintPose(
        {random.Uniform(-0.4, 0.4) * distance, random.Uniform(-0.3, 0.3) * distance, distance},
        random.Uniform(0.4, 0.7), random.Uniform(0, 6), random.Uniform(0, 6));
    const cv::Mat image = AddNoise(Draw(SpokedPrint(pattern_, 4), truth), 3, &random);
    const LandingReport report = Detect(image);
    ASSERT_TRUE(report.detection) << i << ": " << report.reason;
    const LandingDetection& detection = *report.detection;
    if (!detection.mirror_camera_from_pattern) continue;
    ++mirrored;
    const RigidTransform& mirror = *detection.mirror_camera_from_pattern;
    const auto tilt = [&](const RigidTransform& pose) {
      return PoseError(pose, truth).tail<3>().norm();
    };
    wrong += tilt(detection.camera_from_pattern) > tilt(mirror);
    const Eigen::Vector3d away = mirror.translation - detection.camera_from_pattern.translation;
    const Eigen::Matrix3d covariance = detection.covariance.topLeftCorner<3, 3>();
    EXPECT_LT(std::sqrt(away.dot(covariance.ldlt().solve(away))), 5) << i << ": sigma";
  }
  EXPECT_GT(mirrored, 30);
  EXPECT_LT(wrong, 0.1 * mirrored);
}

TEST_F(LandingPatternDetectorTest, StagesAreCountedAndTimed) {
  const LandingReport report = Detect(image_);
  ASSERT_TRUE(report.detection);
  for (const LandingStage stage :
       {LandingStage::kAreas, LandingStage::kRing, LandingStage::kCross, LandingStage::kMatch,
        LandingStage::kLocate, LandingStage::kFound}) {
    EXPECT_GT(report.candidates[static_cast<int>(stage)], 0) << ToString(stage);
  }
  EXPECT_GT(std::accumulate(report.stage_ns.begin(), report.stage_ns.end(), std::int64_t{0}), 0);
}

TEST(LandingPatternDetectorOptions, EveryViolationIsNamed) {
  LandingPatternDetectorOptions options;
  EXPECT_TRUE(options.Validate().empty());
  options.pattern.board_size_m = 0.2;
  options.min_ring_px = 1;
  options.min_quality = NAN;
  options.max_partial_altitude_m = -1;
  options.max_search_ms = -1;
  EXPECT_EQ(options.Validate().size(), 5u);
  const CameraModel camera = TestPrintCamera();
  try {
    LandingPatternDetector detector(camera, options);
    FAIL();
  } catch (const InputError& error) {
    for (const char* key : {"board_size_m", "min_ring_px", "min_quality", "max_partial_altitude_m",
                            "max_search_ms"}) {
      EXPECT_THAT(error.what(), HasSubstr(key));
    }
  }
}

TEST(LandingStage, HasANameEach) {
  EXPECT_STREQ(ToString(LandingStage::kBinarize), "binarize");
  EXPECT_STREQ(ToString(LandingStage::kFound), "found");
  EXPECT_STREQ(ToString(CrossMethod::kPartial), "partial");
  EXPECT_STREQ(ToString(CrossMethod::kQuadrants), "quadrants");
}

}  // namespace
}  // namespace kestrel
