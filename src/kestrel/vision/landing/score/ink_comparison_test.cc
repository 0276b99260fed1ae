// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/score/ink_comparison.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

class InkComparisonTest : public ::testing::Test {
 protected:
  struct Compared {
    double seen;
    PrintDoubts doubts;
    double operator[](PrintDoubt doubt) const { return doubts[doubt]; }
    double Worst() const {
      double worst = 0;
      for (const PrintDoubt doubt :
           {PrintDoubt::kInklessArm, PrintDoubt::kDarkQuadrants, PrintDoubt::kInkOnWhite,
            PrintDoubt::kDarkHub, PrintDoubt::kOtherSpokes, PrintDoubt::kDarkBoard,
            PrintDoubt::kDarkCorners}) {
        worst = std::max(worst, doubts[doubt]);
      }
      return worst;
    }
  };

  Compared Compare(const cv::Mat& image) const { return Compare(image, pose_); }
  Compared Compare(const cv::Mat& image, const RigidTransform& pose) const {
    Compared compared{};
    const PatternView view(camera_, pose, comparison_.extent_m(), {});
    EXPECT_TRUE(view.valid());
    compared.seen = comparison_.Doubt(image, view, &compared.doubts);
    return compared;
  }
  Compared Compare(const Print& print) const { return Compare(Draw(print)); }
  cv::Mat Draw(const Print& print) const { return DrawPrint(camera_, pattern_, print, pose_); }

  // 'transmission': share of the light that remains where 'is_shaded', in the plane of the print.
  cv::Mat Shade(const cv::Mat& image, double transmission, const Print& is_shaded) const {
    cv::Mat shaded = image.clone();
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        const Eigen::Vector2d point = PrintPoint(u, v);
        std::uint8_t& gray = shaded.at<std::uint8_t>(v, u);
        if (is_shaded(point.x(), point.y()))
          gray = cv::saturate_cast<std::uint8_t>(transmission * gray);
      }
    }
    return shaded;
  }

  // Adds light around a point of the print, 'gray' in its middle.
  cv::Mat Shine(const cv::Mat& image, const Eigen::Vector2d& at, double sigma_m,
                double gray) const {
    cv::Mat lit = image.clone();
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        const double distance = (PrintPoint(u, v) - at).norm() / sigma_m;
        std::uint8_t& pixel = lit.at<std::uint8_t>(v, u);
        pixel =
            cv::saturate_cast<std::uint8_t>(pixel + gray * std::exp(-0.5 * distance * distance));
      }
    }
    return lit;
  }

  // Returns the point of the print (m) that a pixel shows.
  Eigen::Vector2d PrintPoint(int u, int v) const {
    const RigidTransform pattern_from_camera = pose_.Inverse();
    Eigen::Vector3d ray;
    camera_.Unproject({static_cast<double>(u), static_cast<double>(v)}, &ray);
    ray = pattern_from_camera.rotation * ray;
    const Eigen::Vector3d& origin = pattern_from_camera.translation;
    return (origin - origin.z() / ray.z() * ray).head<2>();
  }

  const LandingPattern pattern_{};
  const CameraModel camera_ = TestPrintCamera();
  const InkComparison comparison_{pattern_};
  const RigidTransform pose_ = PrintPose({0.1, -0.05, 2.5}, 0.4, 1, 0.3);
  const Print print_ = SpokedPrint(pattern_, 4);
};

TEST_F(InkComparisonTest, TruePrintRaisesNoDoubts) {
  const Compared compared = Compare(print_);
  EXPECT_EQ(compared.seen, 1);
  EXPECT_LT(compared.Worst(), 0.03);
  EXPECT_LT(compared[PrintDoubt::kUnlike], std::log(0.05));
}

// Shadows of a body, arms and turning rotors at any place; of an edge; and of a fence.
TEST_F(InkComparisonTest, ShadowsRaiseNoDoubts) {
  const cv::Mat even = Draw(print_);
  const auto uav = [](double turn, double at) {
    return [=](double x, double y) {
      const double u = std::cos(turn) * (x - at) + std::sin(turn) * y;
      const double v = -std::sin(turn) * (x - at) + std::cos(turn) * y;
      const bool is_arm =
          std::min(std::abs(u - v), std::abs(u + v)) < 0.04 && std::hypot(u, v) < 0.4;
      const bool is_rotor = std::hypot(std::abs(u) - 0.28, std::abs(v) - 0.28) < 0.14;
      return is_arm || is_rotor || (std::abs(u) < 0.16 && std::abs(v) < 0.1);
    };
  };
  for (const double transmission : {0.35, 0.5, 0.7}) {
    for (int i = 0; i < 12; ++i) {
      const Compared compared = Compare(Shade(even, transmission, uav(0.5 * i, 0.08 * i - 0.45)));
      EXPECT_LT(compared[PrintDoubt::kInklessArm], 0.15) << transmission << " " << i;
      EXPECT_LT(compared[PrintDoubt::kDarkQuadrants], 0.4) << transmission << " " << i;
      EXPECT_LT(compared[PrintDoubt::kInkOnWhite], 0.05) << transmission << " " << i;
      EXPECT_LT(compared[PrintDoubt::kOtherSpoke], 0.5) << transmission << " " << i;
      EXPECT_LT(compared[PrintDoubt::kDarkBoard], 0.1) << transmission << " " << i;
    }
    const auto edge = [](double x, double y) { return 0.6 * x + 0.8 * y > 0.1; };
    EXPECT_LT(Compare(Shade(even, transmission, edge)).Worst(), 0.1) << transmission;
  }
}

TEST_F(InkComparisonTest, OtherSignsRaiseDoubts) {
  const Print three_arms = [this](double x, double y) {
    return print_(x, y) && !(x > 0.06 && std::abs(y) < 0.06 && x < 0.39);
  };
  const Print hub = [this](double x, double y) { return print_(x, y) || std::hypot(x, y) < 0.18; };
  const Print ring = [this](double x, double y) { return IsRing(pattern_, x, y); };
  const Print disc = [](double x, double y) { return std::hypot(x, y) < 0.5; };
  const Print crosshair = [this](double x, double y) {
    return print_(x, y) || (std::min(std::abs(x), std::abs(y)) < 0.05 && std::hypot(x, y) < 0.8);
  };
  const Print dark_board = [this](double x, double y) {
    return print_(x, y) || std::hypot(x, y) > 0.5;
  };
  EXPECT_GT(Compare(three_arms)[PrintDoubt::kInklessArm], 0.9);
  EXPECT_GT(Compare(ring)[PrintDoubt::kInklessArm], 0.9);
  EXPECT_GT(Compare(hub)[PrintDoubt::kDarkHub], 0.45);
  EXPECT_GT(Compare(disc)[PrintDoubt::kInklessArm], 0.9);
  EXPECT_GT(Compare(crosshair)[PrintDoubt::kDarkCorners], 0.15);
  EXPECT_GT(Compare(dark_board)[PrintDoubt::kDarkBoard], 0.8);
  EXPECT_GT(Compare(SpokedPrint(pattern_, 8))[PrintDoubt::kOtherSpokes], 0.7);
  EXPECT_GT(Compare(SpokedPrint(pattern_, 3)).Worst(), 0.5);
  EXPECT_GT(Compare(SpokedPrint(pattern_, 5)).Worst(), 0.5);
}

// Ground beyond a board that is smaller than described is no ring: it has no white behind it.
TEST_F(InkComparisonTest, OtherRingRaisesDoubt) {
  for (const double outer_m : {0.26, 0.28, 0.3}) {
    const Print doubled = [=, this](double x, double y) {
      const double radius_m = std::hypot(x, y);
      return print_(x, y) || (radius_m < outer_m && radius_m > outer_m - 0.06);
    };
    EXPECT_GT(Compare(doubled)[PrintDoubt::kDarkBoard], 0.4) << outer_m;
  }
  for (const double outer_m : {0.62, 0.65, 0.68}) {
    for (const double width_m : {0.05, 0.1}) {
      const Print doubled = [=, this](double x, double y) {
        const double radius_m = std::hypot(x, y);
        return print_(x, y) || (radius_m < outer_m && radius_m > outer_m - width_m);
      };
      EXPECT_GT(Compare(doubled)[PrintDoubt::kDarkBoard], 0.4) << outer_m << " " << width_m;
    }
    const Print small_board = [=, this](double x, double y) {
      return print_(x, y) || std::hypot(x, y) > outer_m + 0.02;
    };
    EXPECT_LT(Compare(small_board)[PrintDoubt::kDarkBoard], 0.1) << outer_m;
  }
}

TEST_F(InkComparisonTest, FlatImageIsUnlikePrint) {
  const Compared compared = Compare(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)));
  EXPECT_EQ(compared[PrintDoubt::kInklessArm], 1);
  EXPECT_EQ(compared[PrintDoubt::kUnlike], 0);
}

// A highlight that saturates the image hides the ink of an arm, and veils the ink around. What it
// hides does not speak against the print, unlike a patch of white as large.
TEST_F(InkComparisonTest, HighlightExcusesHiddenArm) {
  const cv::Mat even = Draw(print_);
  for (const double sigma_m : {0.06, 0.2}) {
    const cv::Mat lit = Shine(even, {0.2, 0}, sigma_m, 400);
    EXPECT_LT(Compare(lit)[PrintDoubt::kInklessArm], 0.6) << sigma_m;
  }
  const Print patched = [this](double x, double y) {
    return print_(x, y) && std::hypot(x - 0.2, y) > 0.12;
  };
  EXPECT_GT(Compare(1.5 * Draw(patched))[PrintDoubt::kInklessArm], 0.65);
}

// White between sharp edges is no highlight, however bright the board is.
TEST_F(InkComparisonTest, OverexposedBoardExcusesNoMissingArm) {
  for (const int arms : {0, 1, 2, 3}) {
    const Print sign = [&](double x, double y) {
      const bool is_cross = std::min(std::abs(x), std::abs(y)) < 0.05 && std::hypot(x, y) < 0.39;
      const int arm = std::abs(x) > std::abs(y) ? (x > 0 ? 3 : 1) : (y > 0 ? 0 : 2);
      return IsRing(pattern_, x, y) || (is_cross && arm < arms);
    };
    EXPECT_GT(Compare(1.5 * Draw(sign))[PrintDoubt::kInklessArm], 0.9) << arms;
    const cv::Mat beside = Shine(1.5 * Draw(sign), {-0.3, -0.3}, 0.15, 300);
    EXPECT_GT(Compare(beside)[PrintDoubt::kInklessArm], 0.9) << arms;
  }
  EXPECT_LT(Compare(1.5 * Draw(print_))[PrintDoubt::kInklessArm], 0.03);
}

// Neither blur, which makes the end of an arm look like a highlight that fades out, nor even light
// on the ink excuses the rest of the arm.
TEST_F(InkComparisonTest, OverexposedBoardExcusesNoShortArm) {
  const Print short_arm = [this](double x, double y) {
    return print_(x, y) && !(x > 0.16 && std::abs(y) < 0.06 && x < 0.39);
  };
  for (const double distance_m : {2.5, 5.0, 9.0}) {
    const RigidTransform pose = PrintPose({0.1, -0.05, distance_m}, 0.4, 1, 0.3);
    cv::Mat image = 1.5 * DrawPrint(camera_, pattern_, short_arm, pose);
    for (const double veil : {0.0, 60.0}) {
      image += veil;
      EXPECT_GT(Compare(image, pose)[PrintDoubt::kInklessArm], 0.5) << distance_m << " " << veil;
    }
  }
}

}  // namespace
}  // namespace kestrel
