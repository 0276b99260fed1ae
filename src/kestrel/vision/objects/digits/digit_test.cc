// SPDX-License-Identifier: BSD-3-Clause
// From a painted cuboid to its digit: tests of cuboid_face, digit_image, digit_classifier and otsu.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/vision/objects/digits/digit_classifier.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/objects/shapes/cuboid_face.h"
#include "kestrel/vision/objects/shapes/otsu.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

// A red cuboid seen from above and aside: upper face with a digit, a dark side face below it.
struct CuboidView {
  cv::Mat image;
  FaceCorners corners;
};

CuboidView DrawCuboid(const std::string& digit, double angle) {
  cv::Mat face(200, 200, CV_8UC3, cv::Scalar(40, 35, 190));
  int baseline = 0;
  const cv::Size size = cv::getTextSize(digit, cv::FONT_HERSHEY_SIMPLEX, 4.5, 18, &baseline);
  cv::putText(face, digit, {(200 - size.width) / 2, (200 + size.height) / 2},
              cv::FONT_HERSHEY_SIMPLEX, 4.5, cv::Scalar(235, 235, 235), 18, cv::LINE_AA);
  CuboidView view;
  cv::Mat fine(480, 480, CV_8UC3, cv::Scalar(95, 115, 130));
  const std::vector<cv::Point2f> from = {{0, 0}, {200, 0}, {200, 200}, {0, 200}};
  std::vector<cv::Point2f> to;
  for (int i = 0; i < 4; ++i) {
    const double t = angle + 1.5707963267948966 * i;
    const Eigen::Vector2d corner(60 + 24 * std::cos(t), 55 + 22 * std::sin(t));
    view.corners[i] = corner;
    to.emplace_back(static_cast<float>(4 * (corner.x() + 0.5) - 0.5),
                    static_cast<float>(4 * (corner.y() + 0.5) - 0.5));
  }
  const cv::Point down(0, 60);
  std::vector<cv::Point> side;
  for (const cv::Point2f& p : to) {
    side.push_back(cv::Point(p));
    side.push_back(cv::Point(p) + down);
  }
  std::vector<cv::Point> hull;
  cv::convexHull(side, hull);
  cv::fillConvexPoly(fine, hull, cv::Scalar(22, 20, 110));
  cv::warpPerspective(face, fine, cv::getPerspectiveTransform(from, to), fine.size(),
                      cv::INTER_AREA, cv::BORDER_TRANSPARENT);
  cv::resize(fine, view.image, cv::Size(120, 120), 0, 0, cv::INTER_AREA);
  cv::GaussianBlur(view.image, view.image, cv::Size(), 0.6);
  return view;
}

std::optional<FaceCorners> FindFace(const cv::Mat& image) {
  static const ColorGrid grid(DefaultObjectModel().colors);
  SegmentationWorkspace workspace;
  SegmentSearch search(image, grid, &workspace);
  search.SearchAll(3);
  Segment segment;
  if (!search.Next(&segment)) return std::nullopt;
  search.JoinAmbiguous(&segment);
  CuboidFaceWorkspace face;
  const auto corners = FindCuboidFace(image, segment, &face);
  return corners ? RefineCorners(image, *corners) : std::nullopt;
}

TEST(FindCuboidFace, FindsCornersOfUpperFace) {
  for (const double angle : {0.1, 0.5, 0.9, 1.3}) {
    const CuboidView view = DrawCuboid("5", angle);
    const auto corners = FindFace(view.image);
    ASSERT_TRUE(corners) << angle;
    for (const Eigen::Vector2d& truth : view.corners) {
      const auto nearest =
          std::min_element(corners->begin(), corners->end(),
                           [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
                             return (a - truth).norm() < (b - truth).norm();
                           });
      EXPECT_LT((*nearest - truth).norm(), 1.2) << angle;
    }
  }
}

TEST(FindCuboidFace, FindsNoFaceWithoutDigit) {
  EXPECT_FALSE(FindFace(DrawCuboid(" ", 0.3).image));
}

TEST(Digits, ReadsDigitsInEveryOrientation) {
  const DigitClassifier classifier(DefaultDigitModel());
  for (int digit = 0; digit < 10; ++digit) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      const CuboidView view = DrawCuboid(std::to_string(digit), 0.2 + 1.5707963 * quarter);
      const auto image = CutOutDigit(view.image, view.corners);
      ASSERT_TRUE(image);
      const DigitLikelihoods likelihoods = classifier.Classify(*image);
      const auto best = std::max_element(likelihoods.begin(), likelihoods.end());
      const int found = static_cast<int>(best - likelihoods.begin());
      // A 6 upside down is a 9.
      EXPECT_EQ(found == 9 ? 6 : found, digit == 9 ? 6 : digit) << quarter;
    }
  }
}

// Probability of the likeliest digit on a cuboid with this text; nothing where no figure is cut
// out.
std::optional<LikelyDigit> ReadText(const std::string& text, double angle) {
  static const DigitClassifier classifier(DefaultDigitModel());
  const CuboidView view = DrawCuboid(text, angle);
  const auto image = CutOutDigit(view.image, view.corners);
  if (!image) return std::nullopt;
  return LikeliestDigit(classifier.Classify(*image));
}

// An E and an N that lie on their side look like a 3 and a 2.
TEST(Digits, RarelyTakesOtherFiguresForDigits) {
  int cut_out = 0, taken = 0;
  for (const char* text : {"A", "E", "F", "H", "K", "M", "N", "P", "R", "T", "U",
                           "V", "W", "X", "Y", "#", "+", "=", "&", "%", "*", "m"}) {
    const auto likely = ReadText(text, 0.2);
    cut_out += likely.has_value();
    taken += likely && likely->probability > 0.9;
  }
  EXPECT_GE(cut_out, 20);
  EXPECT_LE(taken, 2);
}

TEST(Digits, KeepsDigitsLikely) {
  for (int digit = 0; digit < kDigitCount; ++digit) {
    const bool has_twin = digit == 6 || digit == 9;  // each is at most half as likely
    const auto likely = ReadText(std::to_string(digit), 0.7);
    ASSERT_TRUE(likely) << digit;
    EXPECT_EQ(likely->digit, digit == 9 ? 6 : digit);
    EXPECT_GT(likely->probability, has_twin ? 0.45 : 0.7) << digit;
  }
}

TEST(CutOutDigit, UprightsItalics) {
  const CuboidView view = DrawCuboid("4", 0.2);
  CuboidView slanted = view;  // a square figure appears slanted on a face that is a parallelogram
  const cv::Matx23d shear(1, -0.25, 0.25 * 55, 0, 1, 0);
  cv::warpAffine(view.image, slanted.image, shear, view.image.size());
  const auto upright = CutOutDigit(view.image, view.corners);
  const auto italic = CutOutDigit(slanted.image, slanted.corners);
  ASSERT_TRUE(upright && italic);
  double difference = 0;
  double ink = 0;
  for (std::size_t i = 0; i < upright->front().size(); ++i) {
    difference += std::abs(upright->front()[i] - italic->front()[i]);
    ink += upright->front()[i];
  }
  EXPECT_LT(difference, 0.2 * ink);
}

TEST(CutOutDigit, ViewsAreQuarterTurns) {
  const CuboidView view = DrawCuboid("7", 0.2);
  CuboidView turned = view;
  std::rotate(turned.corners.begin(), turned.corners.begin() + 1, turned.corners.end());
  const auto first = CutOutDigit(view.image, view.corners);
  const auto second = CutOutDigit(turned.image, turned.corners);
  ASSERT_TRUE(first && second);
  for (int quarter = 0; quarter < 4; ++quarter) {
    double difference = 0;
    for (std::size_t i = 0; i < first->front().size(); ++i) {
      difference += std::abs((*first)[quarter][i] - (*second)[(quarter + 1) % 4][i]);
    }
    EXPECT_LT(difference, 8) << quarter;
  }
}

TEST(DigitModel, RoundTripsAndRefusesMalformedText) {
  const std::string text = PrintDigitModel(DefaultDigitModel());
  EXPECT_EQ(ParseDigitModel(text, "digits"), DefaultDigitModel());
  const auto error_of = [](const std::string& bad) -> std::string {
    try {
      ParseDigitModel(bad, "digits.txt");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(error_of(""), HasSubstr("digits.txt:1: expected 'digits 10 8 20'"));
  EXPECT_THAT(error_of(text.substr(0, text.size() / 2)), HasSubstr("expected"));
  EXPECT_THAT(error_of(text + "more\n"), HasSubstr("expected the end"));
  std::string bad = text;
  bad[text.find('\n') + 1] = 'x';
  EXPECT_THAT(error_of(bad), HasSubstr("digits.txt:2: expected percent"));
}

TEST(DigitTrainer, CountsAndNeverReachesCertainty) {
  DigitTrainer trainer;
  DigitImage image{};
  image[5] = 1;
  for (int i = 0; i < 8; ++i) trainer.Add(3, image);
  const DigitModel model = trainer.Model();
  EXPECT_FLOAT_EQ(model[3 * kStyleCount][5], 0.9F);
  EXPECT_FLOAT_EQ(model[3 * kStyleCount][6], 0.1F);
  EXPECT_FLOAT_EQ(model[4 * kStyleCount][6], 0.5F);
}

TEST(DigitTrainer, SeparatesStyles) {
  DigitTrainer trainer;
  DigitImage thin{};
  thin[5] = 1;
  DigitImage bold{};
  bold[5] = bold[6] = bold[7] = 1;
  for (int i = 0; i < 600; ++i) trainer.Add(3, i < 350 ? thin : bold);
  const DigitClassifier classifier(trainer.Model());
  EXPECT_NE(classifier.LikeliestFigure(thin, 3), classifier.LikeliestFigure(bold, 3));
}

TEST(SplitByOtsu, SeparatesTwoHills) {
  Histogram histogram{};
  histogram[40] = histogram[50] = 100;
  histogram[200] = 30;
  const OtsuSplit split = SplitByOtsu(histogram);
  EXPECT_GE(split.threshold, 50);
  EXPECT_LT(split.threshold, 200);
  EXPECT_DOUBLE_EQ(split.lower_mean, 45);
  EXPECT_DOUBLE_EQ(split.upper_mean, 200);
  EXPECT_EQ(SplitByOtsu(Histogram{}).upper_mean, 0);
}

}  // namespace
}  // namespace kestrel
