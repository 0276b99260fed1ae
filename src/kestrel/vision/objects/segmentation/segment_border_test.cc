// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/segmentation/segment_border.h"

#include <vector>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

const cv::Size kImage(40, 30);

SegmentBorder BorderOfRectangle(int left, int top, int right, int bottom) {
  std::vector<PixelPosition> pixels;
  for (int v = top; v <= bottom; ++v) {
    for (int u = left; u <= right; ++u) {
      pixels.push_back({static_cast<std::int16_t>(u), static_cast<std::int16_t>(v)});
    }
  }
  Segment segment;
  segment.pixels = pixels;
  segment.min_u = left;
  segment.max_u = right;
  segment.min_v = top;
  segment.max_v = bottom;
  SegmentBorder border;
  FindBorder(segment, kImage, &border);
  return border;
}

TEST(FindBorder, ReturnsRowAndColumnEndsHalfPixelOutwards) {
  const SegmentBorder border = BorderOfRectangle(10, 12, 14, 14);
  EXPECT_EQ(border.points.size(), 2 * (5 + 3));
  EXPECT_TRUE(border.cut.empty());
  for (const Eigen::Vector2d& point : border.points) {
    const bool is_end_of_row = point.x() == 9.5 || point.x() == 14.5;
    const bool is_end_of_column = point.y() == 11.5 || point.y() == 14.5;
    EXPECT_NE(is_end_of_row, is_end_of_column) << point.transpose();
  }
}

TEST(FindBorder, SeparatesImageBorder) {
  const SegmentBorder border = BorderOfRectangle(0, 12, 4, 14);
  EXPECT_EQ(border.cut.size(), 3 + 2 * 2);  // left ends, and the columns at the border
  for (const Eigen::Vector2d& point : border.points) EXPECT_GT(point.x(), 1);
}

}  // namespace
}  // namespace kestrel
