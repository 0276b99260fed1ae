// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/overlays/map_inset.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

MappedObject RedDiscAt(double x, double y) {
  MappedObject object;
  object.state.head<2>() << x, y;
  object.color = {0, 1, 1};
  return object;
}

bool IsRed(const cv::Vec3b& pixel) { return pixel[2] > 200 && pixel[1] < 60 && pixel[0] < 60; }

// Mean position of the red pixels.
Eigen::Vector2d RedPlace(const cv::Mat& image) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      if (!IsRed(image.at<cv::Vec3b>(v, u))) continue;
      sum += Eigen::Vector2d(u, v);
      ++count;
    }
  }
  EXPECT_GT(count, 20);
  return sum / count;
}

cv::Mat Draw(const std::vector<MappedObject>& objects, const std::optional<Eigen::Vector2d>& uav,
             const std::vector<cv::Rect>& seen = {}) {
  cv::Mat image(480, 640, CV_8UC3, cv::Scalar::all(100));
  DrawMapInset(objects, DefaultObjectModel(), uav, seen, &image);
  return image;
}

TEST(DrawMapInset, NorthIsUpAndEastIsRight) {
  // The object moves away from the UAV.
  const Eigen::Vector2d uav(0, 0);
  const Eigen::Vector2d north = RedPlace(Draw({RedDiscAt(0, 10)}, uav));
  const Eigen::Vector2d south = RedPlace(Draw({RedDiscAt(0, -10)}, uav));
  const Eigen::Vector2d east = RedPlace(Draw({RedDiscAt(10, 0)}, uav));
  EXPECT_LT(north.y(), south.y() - 20);
  EXPECT_GT(east.x(), north.x() + 20);
}

TEST(DrawMapInset, KeepsRestOfImage) {
  const cv::Mat image = Draw({RedDiscAt(3, 4)}, std::nullopt);
  EXPECT_EQ(image.at<cv::Vec3b>(10, 10), cv::Vec3b::all(100));
  EXPECT_EQ(image.at<cv::Vec3b>(470, 10), cv::Vec3b::all(100));
  EXPECT_NE(image.at<cv::Vec3b>(470, 600), cv::Vec3b::all(100));
}

TEST(DrawMapInset, LiesInLeastOccupiedCorner) {
  const cv::Rect lower_right(560, 420, 40, 40), lower_left(30, 400, 20, 20);
  const cv::Mat image = Draw({RedDiscAt(3, 4)}, std::nullopt, {lower_right, lower_left});
  EXPECT_EQ(image.at<cv::Vec3b>(470, 600), cv::Vec3b::all(100));
  EXPECT_EQ(image.at<cv::Vec3b>(470, 10), cv::Vec3b::all(100));
  EXPECT_NE(image.at<cv::Vec3b>(10, 600), cv::Vec3b::all(100));
}

TEST(DrawMapInset, DrawsNoEmptyMap) {
  EXPECT_EQ(Draw({}, Eigen::Vector2d(0, 0)).at<cv::Vec3b>(470, 600), cv::Vec3b::all(100));
}

}  // namespace
}  // namespace kestrel
