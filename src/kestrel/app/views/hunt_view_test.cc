// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/views/hunt_view.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace kestrel {
namespace {

using ::testing::HasSubstr;

// The mean of the heaviest component of this class's colour.
cv::Vec3b Paint(const ObjectModel& model, const std::string& name) {
  const auto& colors = model.colors.colors;
  const auto color = std::find_if(colors.begin(), colors.end(),
                                  [&](const ColorMixture& one) { return one.name == name; });
  const auto heaviest = std::max_element(
      color->components.begin(), color->components.end(),
      [](const ColorComponent& a, const ColorComponent& b) { return a.weight < b.weight; });
  const Hsv& mean = heaviest->mean;
  cv::Mat bgr;
  cv::cvtColor(cv::Mat(1, 1, CV_32FC3, cv::Scalar(mean.hue_deg, mean.saturation, mean.value)), bgr,
               cv::COLOR_HSV2BGR);
  return 255 * bgr.at<cv::Vec3f>(0, 0);
}

TEST(HuntViewTest, DrawsSegmentsInTheirColourAndSpecksDarker) {
  const ObjectModel model = DefaultObjectModel();
  cv::Mat image(60, 80, CV_8UC3, cv::Scalar(90, 100, 95));
  image(cv::Rect(10, 10, 20, 20)).setTo(Paint(model, "red"));
  image(cv::Rect(50, 40, 3, 3)).setTo(Paint(model, "blue"));
  const std::vector<ImageView> views = HuntImageViews({model, {}});
  ASSERT_EQ(views.size(), 1u);
  EXPECT_EQ(views[0].name, "segmentation");
  const cv::Mat drawn = views[0].draw(image);
  ASSERT_EQ(drawn.size(), image.size());
  ASSERT_EQ(drawn.type(), CV_8UC3);
  const auto brightest = [&](int u, int v) {
    const cv::Vec3b& pixel = drawn.at<cv::Vec3b>(v, u);
    return std::max({pixel[0], pixel[1], pixel[2]});
  };
  const cv::Vec3b red = drawn.at<cv::Vec3b>(20, 20);
  EXPECT_EQ(red[2], 255);
  EXPECT_LT(red[0], 128);
  const cv::Vec3b speck = drawn.at<cv::Vec3b>(41, 51);
  EXPECT_EQ(speck[0], brightest(51, 41)) << "blue";
  EXPECT_NEAR(speck[0], 128, 1);
  EXPECT_LT(brightest(70, 5), 70) << "ground";
  EXPECT_EQ(drawn.at<cv::Vec3b>(5, 70)[0], brightest(70, 5)) << "gray";
  EXPECT_TRUE(views[0].draw(cv::Mat(9, 9, CV_8UC1, cv::Scalar(1))).empty());
}

TEST(HuntViewTest, RejectedObjectShowsReason) {
  HuntObservation observation;
  observation.report.elsewhere.emplace_back().class_probability = 0.5;
  const HuntView view{DefaultObjectModel(), {}};
  const std::vector<OverlayShape> shapes = HuntShapes(view, observation);
  ASSERT_EQ(shapes.size(), 1u);
  EXPECT_EQ(shapes[0].layer, OverlayLayer::kRejected);
  EXPECT_THAT(shapes[0].label, HasSubstr(" 0.50, by its size not on the ground"));
  observation.world_from_camera.emplace();
  observation.report.passed = {12, 3, 3, 1, 0, 0};
  EXPECT_EQ(HuntStatus(observation).reason,
            "rejected: 9 by size, 2 by shape, 1 by outline or digit");
}

}  // namespace
}  // namespace kestrel
