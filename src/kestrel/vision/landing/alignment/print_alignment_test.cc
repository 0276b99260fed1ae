// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/alignment/print_alignment.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/image/local_threshold.h"
#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

constexpr double kReachPx = 6;
constexpr double kMinStep = 10;

// Error (px) of an alignment against the image of the print.
struct AlignmentError {
  double center_px = 0;
  double edges_px = 0;  // across the outlines, root mean square along them
  double largest_px = 0;
};

class PrintAlignmentTest : public ::testing::Test {
 protected:
  PrintAlignment AlignmentAt(const CameraModel& assumed, const RigidTransform& start) const {
    return {PlaneWarp(assumed, start, outline_.radius_m()), {}};
  }
  bool Align(const cv::Mat& image, PrintAlignment* alignment, double reach_px = kReachPx) const {
    return AlignPrint(image, image, {}, outline_.all(), reach_px, kMinStep, alignment);
  }
  // Error for a print that 'camera' sees under 'truth', with 'height' over its plane.
  AlignmentError ErrorOf(const PrintAlignment& alignment, const CameraModel& camera,
                         const RigidTransform& truth, const SheetHeight& height) const {
    const auto off = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
      Eigen::Vector2d shown, aligned;
      camera.Project(truth * Eigen::Vector3d(p.x(), p.y(), height ? height(p.x(), p.y()) : 0),
                     &shown);
      EXPECT_TRUE(alignment.warp.Project(p, &aligned));
      return aligned - shown;
    };
    AlignmentError error;
    error.center_px = off({0, 0}).norm();
    for (const PrintEdge& edge : alignment.edges.all()) {
      const double across = edge.across.dot(off(edge.place->point));
      error.edges_px += across * across / static_cast<double>(alignment.edges.count);
      error.largest_px = std::max(error.largest_px, std::abs(across));
    }
    error.edges_px = std::sqrt(error.edges_px);
    return error;
  }
  // Aligns prints seen through 'camera' with the model 'assumed', from the pose of their ring.
  void ExpectAligned(const std::string& what, const CameraModel& camera, const CameraModel& assumed,
                     const SheetHeight& height = {}) const {
    Random random(1);
    for (const double distance : {0.9, 1.4, 2.5}) {
      for (int trial = 0; trial < 4; ++trial) {
        const RigidTransform truth = PrintPose(
            {random.Uniform(-0.1, 0.1) * distance, random.Uniform(-0.1, 0.1) * distance, distance},
            random.Uniform(0, 0.5), random.Uniform(0, 6), random.Uniform(0, 6));
        RigidTransform start = truth;
        start.translation.z() *= assumed.intrinsics().fx_px / camera.intrinsics().fx_px;
        const Print print = SpokedPrint(pattern_, 4);
        const cv::Mat image =
            AddNoise(DrawPrint(camera, pattern_, print, truth, height), 2, &random);
        PrintAlignment alignment = AlignmentAt(assumed, start);
        // The reach follows from the diameter, as in the detector.
        ASSERT_TRUE(Align(image, &alignment, 2 + 0.03 * 220 / distance))
            << what << " at " << distance << " m";
        const AlignmentError error = ErrorOf(alignment, camera, truth, height);
        EXPECT_LT(error.center_px, 1) << what << " at " << distance << " m, " << trial;
        EXPECT_LT(error.edges_px, 0.8) << what << " at " << distance << " m, " << trial;
        EXPECT_LT(error.largest_px, 1 + 0.01 * 220 / distance)
            << what << " at " << distance << " m, " << trial;
        EXPECT_GT(alignment.EdgeShares().MeansInView().arms, 0.9) << what;
        EXPECT_GT(alignment.EdgeShares().MeansInView().ring, 0.9) << what;
      }
    }
  }

  const LandingPattern pattern_{};
  const PrintOutline outline_{pattern_};
  const CameraModel camera_ = TestPrintCamera();
};

TEST_F(PrintAlignmentTest, LocatesFlatPrintWithRightLens) {
  ExpectAligned("flat", camera_, camera_);
}

TEST_F(PrintAlignmentTest, WrongFocalLengthDoesNotMovePrint) {
  for (const double zoom : {0.7, 0.8, 0.9, 1.1, 1.2, 1.3}) {
    CameraIntrinsics wrong = camera_.intrinsics();
    wrong.fx_px *= zoom;
    wrong.fy_px *= zoom;
    ExpectAligned("zoom " + std::to_string(zoom), camera_, CameraModel(wrong));
  }
}

TEST_F(PrintAlignmentTest, OmittedDistortionDoesNotMovePrint) {
  CameraIntrinsics barrel = camera_.intrinsics();
  barrel.distortion_model = DistortionModel::kRadialTangential;
  barrel.distortion = {-0.28, 0.07, 0, 0};
  ExpectAligned("barrel", CameraModel(barrel), camera_);
}

TEST_F(PrintAlignmentTest, FollowsUnevenSheets) {
  for (const double height_m : {0.045, -0.045}) {  // 3 % of the board
    ExpectAligned("bulge", camera_, camera_, [=](double x, double y) {
      return height_m * (1 - (x * x + y * y) / (0.75 * 0.75));
    });
  }
  ExpectAligned("fold", camera_, camera_,
                [](double x, double /*y*/) { return 0.03 * (1 - std::abs(x) / 0.75); });
}

TEST_F(PrintAlignmentTest, CenterErrorsMatchCovariance) {
  Random random(3);
  const RigidTransform truth = PrintPose({0.1, -0.05, 2}, 0.3, 1, 0.3);
  const cv::Mat image = DrawPrint(camera_, pattern_, SpokedPrint(pattern_, 4), truth);
  Eigen::Vector2d center;
  camera_.Project(truth.translation, &center);
  constexpr int kTrials = 60;
  double squares = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    PrintAlignment alignment = AlignmentAt(camera_, truth);
    ASSERT_TRUE(Align(AddNoise(image, 12, &random), &alignment));
    Eigen::Vector2d found;
    alignment.warp.Project(Eigen::Vector2d::Zero(), &found);
    squares += (found - center).squaredNorm() /
               (2 * alignment.center_sigma_px * alignment.center_sigma_px);
  }
  EXPECT_GT(std::sqrt(squares / kTrials), 0.6);
  EXPECT_LT(std::sqrt(squares / kTrials), 1.6);
}

// Other figures are not bent until they match the print.
TEST_F(PrintAlignmentTest, DoesNotDistortOtherFiguresIntoPrint) {
  const RigidTransform pose = PrintPose({0.1, -0.05, 1.6}, 0.3, 1, 0.3);
  const Print rings = [this](double x, double y) {
    const double radius = std::hypot(x, y);
    return IsRing(pattern_, x, y) || (radius > 0.2 && radius < 0.3);
  };
  const Print empty = [this](double x, double y) { return IsRing(pattern_, x, y); };
  const Print square = [](double x, double y) {
    const double reach = std::max(std::abs(x), std::abs(y));
    return reach > 0.35 && reach < 0.45;
  };
  struct Other {
    const char* name;
    Print print;
  };
  for (const Other& other :
       {Other{"a ring in a ring", rings}, Other{"an empty ring", empty},
        Other{"three arms", SpokedPrint(pattern_, 3)}, Other{"a square", square}}) {
    PrintAlignment alignment = AlignmentAt(camera_, pose);
    if (!Align(DrawPrint(camera_, pattern_, other.print, pose), &alignment)) continue;
    const PartShares::Means means = alignment.EdgeShares().MeansInView();
    EXPECT_LT(std::min(means.worst_arm, means.ring), 0.6) << other.name;
  }
}

TEST_F(PrintAlignmentTest, IgnoresQuarterOutOfView) {
  const RigidTransform pose = PrintPose({1.05, 0, 1.6}, 0, 0, 0);
  PrintAlignment alignment = AlignmentAt(camera_, pose);
  ASSERT_TRUE(Align(DrawPrint(camera_, pattern_, SpokedPrint(pattern_, 4), pose), &alignment));
  const PartShares shares = alignment.EdgeShares();
  EXPECT_LT(shares.arm[0], 0);
  EXPECT_GT(shares.arm[2], 0.8);
  EXPECT_GT(shares.ring[2], 0.8);
}

// From a start that is far off, the print is found on an image of half the resolution.
TEST_F(PrintAlignmentTest, SmallerImageBringsAlignmentNear) {
  const RigidTransform truth = PrintPose({0.02, -0.02, 0.9}, 0.2, 1, 0.3);
  RigidTransform start = truth;
  start.translation.x() += 0.05;  // 12 px
  const cv::Mat image = DrawPrint(camera_, pattern_, SpokedPrint(pattern_, 4), truth);
  TilePyramid pyramid;
  pyramid.Build(image, 1);
  PrintAlignment alignment = AlignmentAt(camera_, start);
  ASSERT_TRUE(
      AlignPrint(image, pyramid.ImageAt(1), {{0, 0}, 1}, outline_.all(), 16, kMinStep, &alignment));
  const AlignmentError error = ErrorOf(alignment, camera_, truth, {});
  EXPECT_LT(error.center_px, 0.2);
  EXPECT_LT(error.edges_px, 0.5);
}

TEST_F(PrintAlignmentTest, FailsWithoutEdges) {
  PrintAlignment alignment = AlignmentAt(camera_, PrintPose({0, 0, 2}, 0, 0, 0));
  EXPECT_FALSE(Align(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)), &alignment));
  PrintAlignment behind = AlignmentAt(camera_, PrintPose({0, 0, -2}, 0, 0, 0));
  EXPECT_FALSE(Align(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)), &behind));
}

}  // namespace
}  // namespace kestrel
