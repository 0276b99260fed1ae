// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/segmentation/segmentation.h"

#include <numbers>
#include <set>
#include <tuple>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/random.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/objects/segmentation/segment_shape.h"

namespace kestrel {
namespace {

const cv::Scalar kRed(40, 40, 200);
const cv::Scalar kGreen(55, 165, 95);
const cv::Scalar kWhite(250, 250, 250);
const cv::Scalar kAsphalt(90, 95, 100);

const ColorGrid& Grid() {
  static const ColorGrid grid(DefaultObjectModel().colors);
  return grid;
}

// Area, bounding box and colour: enough to distinguish segments.
using Key = std::tuple<std::size_t, int, int, int, int, int>;

std::set<Key> FindAll(const cv::Mat& image, int step, std::size_t min_pixels) {
  SegmentationWorkspace workspace;
  SegmentSearch search(image, Grid(), &workspace);
  search.SearchAll(step);
  std::set<Key> found;
  for (Segment s; search.Next(&s);) {
    if (s.pixels.size() < min_pixels) continue;
    found.insert({s.pixels.size(), s.label, s.min_u, s.max_u, s.min_v, s.max_v});
  }
  return found;
}

// Ellipses of all sizes, colours and directions, axes up to 2 : 1, with single-pixel noise.
cv::Mat RandomScene(std::uint64_t seed) {
  Random random(seed);
  cv::Mat image(480, 640, CV_8UC3, kAsphalt);
  for (int i = 0; i < 60; ++i) {
    const double axis = random.Uniform(3, 14);
    const cv::RotatedRect box(cv::Point2f(static_cast<float>(random.Uniform(0, 640)),
                                          static_cast<float>(random.Uniform(0, 480))),
                              cv::Size2f(static_cast<float>(2 * axis),
                                         static_cast<float>(2 * axis * random.Uniform(0.5, 1))),
                              static_cast<float>(random.Uniform(0, 180)));
    cv::ellipse(image, box, random.Chance(0.5) ? kRed : kGreen, cv::FILLED);
  }
  for (int i = 0; i < 500; ++i) {
    image.at<cv::Vec3b>(random.Integer(0, 479), random.Integer(0, 639)) = cv::Vec3b(40, 40, 200);
  }
  return image;
}

TEST(SegmentSearch, CoarseSearchFindsSameSegmentsAsAlgorithm4) {
  constexpr int kMinPixels = 30;
  const int step = SearchStep(kMinPixels);
  EXPECT_GE(step, 3);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const cv::Mat image = RandomScene(seed);
    const std::set<Key> all = FindAll(image, 1, kMinPixels);
    EXPECT_GT(all.size(), 20U);
    EXPECT_EQ(FindAll(image, step, kMinPixels), all) << seed;
  }
}

TEST(SegmentSearch, SeparatesTouchingColours) {
  cv::Mat image(100, 100, CV_8UC3, kAsphalt);
  cv::rectangle(image, cv::Rect(10, 20, 30, 40), kRed, cv::FILLED);
  cv::rectangle(image, cv::Rect(40, 20, 20, 40), kGreen, cv::FILLED);
  EXPECT_EQ(FindAll(image, 3, 1),
            (std::set<Key>{{1200, 1, 10, 39, 20, 59}, {800, 4, 40, 59, 20, 59}}));
}

TEST(SegmentSearch, SearchesSubImageUpToItsBorder) {
  cv::Mat image(100, 120, CV_8UC3, kRed);
  const cv::Mat part = image(cv::Rect(10, 10, 50, 30));
  SegmentationWorkspace workspace;
  SegmentSearch search(part, Grid(), &workspace);
  search.SearchAll(3);
  Segment segment;
  ASSERT_TRUE(search.Next(&segment));
  EXPECT_EQ(segment.pixels.size(), 1500U);
  EXPECT_TRUE(segment.touches_border);
  EXPECT_FALSE(search.Next(&segment));
}

TEST(SegmentSearch, FindsNearestSegmentFirstAndEachOnce) {
  cv::Mat image(200, 200, CV_8UC3, kAsphalt);
  cv::circle(image, {60, 60}, 8, kRed, cv::FILLED);
  cv::circle(image, {120, 60}, 8, kRed, cv::FILLED);
  SegmentationWorkspace workspace;
  SegmentSearch search(image, Grid(), &workspace);
  Segment segment;
  ASSERT_TRUE(search.FindNear(80, 60, 60, std::nullopt, &segment));
  EXPECT_EQ(segment.min_u, 52);
  EXPECT_FALSE(search.FindNear(80, 60, 60, ColorLabel{4}, &segment)) << "none is green";
  ASSERT_TRUE(search.FindNear(80, 60, 60, ColorLabel{1}, &segment));
  EXPECT_EQ(segment.min_u, 112);
  EXPECT_FALSE(search.FindNear(80, 60, 60, std::nullopt, &segment));
}

TEST(SegmentSearch, JoinsEnclosedWhite) {
  cv::Mat image(100, 100, CV_8UC3, kWhite);
  cv::rectangle(image, cv::Rect(30, 30, 40, 40), kRed, cv::FILLED);
  cv::rectangle(image, cv::Rect(45, 40, 8, 20), kWhite, cv::FILLED);
  SegmentationWorkspace workspace;
  SegmentSearch search(image, Grid(), &workspace);
  search.SearchAll(3);
  Segment segment;
  ASSERT_TRUE(search.Next(&segment));
  EXPECT_EQ(segment.pixels.size(), 1440U);
  search.JoinAmbiguous(&segment);
  EXPECT_EQ(segment.pixels.size(), 1600U);
  EXPECT_EQ(segment.ambiguous_pixels, 160);
}

TEST(SegmentationWorkspace, WorksForImagesOfEverySize) {
  SegmentationWorkspace workspace;
  for (const cv::Size& size : {cv::Size(40, 30), cv::Size(200, 100), cv::Size(1, 1)}) {
    const cv::Mat image(size, CV_8UC3, kRed);
    for (int frame = 0; frame < 3; ++frame) {
      SegmentSearch search(image, Grid(), &workspace);
      search.SearchAll(1);
      Segment segment;
      ASSERT_TRUE(search.Next(&segment));
      EXPECT_EQ(static_cast<int>(segment.pixels.size()), size.area());
    }
  }
}

SegmentShape ShapeOf(const cv::Mat& image) {
  SegmentationWorkspace workspace;
  SegmentSearch search(image, Grid(), &workspace);
  search.SearchAll(1);
  Segment segment;
  EXPECT_TRUE(search.Next(&segment));
  return MeasureShape(image, segment);
}

TEST(MeasureShape, MeasuresAxesAndUnitCircularityOfEllipse) {
  cv::Mat image(300, 400, CV_8UC3, kAsphalt);
  cv::ellipse(image, cv::RotatedRect({200.0F, 150.0F}, {160.0F, 80.0F}, 30.0F), kRed, cv::FILLED);
  const SegmentShape shape = ShapeOf(image);
  EXPECT_NEAR(shape.ellipse.center.x(), 200, 0.3);
  EXPECT_NEAR(shape.ellipse.semi_major, 80, 0.8);
  EXPECT_NEAR(shape.ellipse.semi_minor, 40, 0.8);
  EXPECT_NEAR(shape.ellipse.angle, std::numbers::pi / 6, 0.02);
  EXPECT_NEAR(shape.circularity, 1, 0.01);
  EXPECT_NEAR(shape.roundness, 1.25, 0.1) << "the bounding box of an oblique ellipse is larger";
  EXPECT_NEAR(HueDifference(shape.mean_color.hue_deg, 0), 0, 1);
}

TEST(MeasureShape, SquareAndTriangleAreLessCircular) {
  cv::Mat image(300, 300, CV_8UC3, kAsphalt);
  cv::rectangle(image, cv::Rect(50, 50, 100, 100), kRed, cv::FILLED);
  EXPECT_NEAR(ShapeOf(image).circularity, std::numbers::pi / 3, 0.005);
  EXPECT_NEAR(ShapeOf(image).roundness, std::numbers::pi / 4, 0.005);
  image.setTo(kAsphalt);
  const std::vector<cv::Point> triangle = {{50, 200}, {250, 200}, {150, 27}};
  cv::fillPoly(image, std::vector<std::vector<cv::Point>>{triangle}, kRed);
  EXPECT_NEAR(ShapeOf(image).circularity, 1.209, 0.02);
}

}  // namespace
}  // namespace kestrel
