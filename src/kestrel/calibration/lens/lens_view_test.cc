// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/lens_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

RigidTransform TestPose() { return PrintPose({0.2, -0.1, 1.8}, 0.5, 1, 0.7); }

cv::Mat TestImage() {
  Random random(1);
  const LandingPattern pattern;
  return AddNoise(DrawPrint(TestPrintCamera(), pattern, SpokedPrint(pattern, 4), TestPose()), 1,
                  &random);
}

std::optional<LensView> FindWith(double zoom) {
  CameraIntrinsics camera = TestPrintCamera().intrinsics();
  camera.fx_px *= zoom;
  camera.fy_px *= zoom;
  return LensViewFinder(camera, {}).Find("view", TestImage());
}

TEST(LensViewFinderTest, EdgesLieOnProjectedOutline) {
  const std::optional<LensView> view = FindWith(1);
  ASSERT_TRUE(view);
  EXPECT_GT(view->edges.size(), 120u);
  double squares = 0;
  for (const LensEdge& edge : view->edges) {
    // The cross looks the same after a quarter of a turn.
    Eigen::Vector2d nearest(1e9, 1e9);
    for (int quarter = 0; quarter < 4; ++quarter) {
      const Eigen::Vector3d point =
          Eigen::AngleAxisd(quarter * std::numbers::pi / 2, Eigen::Vector3d::UnitZ()) *
          Eigen::Vector3d(edge.on_print.x(), edge.on_print.y(), 0);
      Eigen::Vector2d pixel;
      TestPrintCamera().Project(TestPose() * point, &pixel);
      if ((pixel - edge.pixel).norm() < nearest.norm()) nearest = pixel - edge.pixel;
    }
    squares += std::pow(edge.across.dot(nearest), 2);
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(view->edges.size())), 0.1);
}

TEST(LensViewFinderTest, FindsSameEdgesWithWrongLens) {
  const std::optional<LensView> right = FindWith(1);
  ASSERT_TRUE(right);
  for (const double zoom : {0.8, 1.25}) {
    const std::optional<LensView> wrong = FindWith(zoom);
    ASSERT_TRUE(wrong) << zoom;
    EXPECT_GT(wrong->edges.size(), 120u);
    double squares = 0;
    for (const LensEdge& edge : wrong->edges) {
      double least = 1e9;  // across the outline, from the nearest edge of the other view
      double nearest = 1e9;
      for (const LensEdge& other : right->edges) {
        const Eigen::Vector2d apart = edge.pixel - other.pixel;
        if (apart.norm() > nearest) continue;
        nearest = apart.norm();
        least = std::abs(apart.dot(other.across));
      }
      squares += least * least;
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(wrong->edges.size())), 0.1) << zoom;
  }
}

TEST(LensViewFinderTest, FindsNoViewInEmptyImage) {
  LensViewFinder finder(TestPrintCamera().intrinsics(), {});
  EXPECT_FALSE(finder.Find("gray", cv::Mat(240, 320, CV_8UC1, 90)));
}

TEST(LensViewFinderTest, IgnoresPrintsThatAreTooSmall) {
  const LandingPattern pattern;
  LensViewFinder finder(TestPrintCamera().intrinsics(), {});
  const cv::Mat far = DrawPrint(TestPrintCamera(), pattern, SpokedPrint(pattern, 4),
                                PrintPose({0.2, -0.1, 7}, 0.2, 1, 0.7));
  EXPECT_FALSE(finder.Find("far", far));
}

}  // namespace
}  // namespace kestrel
