// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/color_training/color_stroke.h"

#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr std::size_t kMaxPoints = 1000;

void RequireInside(const ColorStroke& stroke, const cv::Mat& image) {
  const cv::Rect whole({}, image.size());
  for (const cv::Point& point : stroke.points) {
    if (whole.contains(point)) continue;
    throw InputError(
        fmt::format("frame {}: the point [{}, {}] of a {} lies outside of the image, "
                    "which has {} x {} px",
                    stroke.frame, point.x, point.y, ToString(stroke.tool), image.cols, image.rows));
  }
}

void DrawBrush(const ColorStroke& stroke, cv::Mat* mask) {
  const int radius = static_cast<int>(std::lround(stroke.size));
  const cv::Point* last = &stroke.points.front();
  for (const cv::Point& point : stroke.points) {
    cv::line(*mask, *last, point, 255, 2 * radius + 1);
    cv::circle(*mask, point, radius, 255, cv::FILLED);
    last = &point;
  }
}

cv::Mat GrownMask(const ColorStroke& stroke, const cv::Mat& image) {
  constexpr int kMarked = 255;
  // floodFill needs a border of one pixel around its mask.
  cv::Mat mask = cv::Mat::zeros(image.rows + 2, image.cols + 2, CV_8UC1);
  cv::Mat unchanged = image;
  const cv::Scalar reach = cv::Scalar::all(stroke.size);
  cv::floodFill(unchanged, mask, stroke.points.front(), {}, nullptr, reach, reach,
                4 | kMarked << 8 | cv::FLOODFILL_FIXED_RANGE | cv::FLOODFILL_MASK_ONLY);
  return mask(cv::Rect(1, 1, image.cols, image.rows)).clone();
}

}  // namespace

const char* ToString(StrokeTool tool) {
  switch (tool) {
    case StrokeTool::kBrush:
      return "brush";
    case StrokeTool::kRectangle:
      return "rectangle";
    case StrokeTool::kGrow:
      return "grow";
  }
  return "";
}

std::vector<std::string> ColorStroke::Validate() const {
  std::vector<std::string> violations;
  const auto require = [&](bool holds, const char* rule) {
    if (!holds) violations.emplace_back(rule);
  };
  switch (tool) {
    case StrokeTool::kBrush:
      require(size >= 0.5 && size <= 200, "a brush's size must be 0.5 to 200 px");
      require(!points.empty() && points.size() <= kMaxPoints, "a brush has 1 to 1000 points");
      break;
    case StrokeTool::kRectangle:
      require(size == 0, "a rectangle's size must be 0");
      require(points.size() == 2, "a rectangle has two points");
      break;
    case StrokeTool::kGrow:
      require(size >= 1 && size <= 100, "the size of what is grown must be 1 to 100");
      require(points.size() == 1, "what is grown has one point");
      break;
  }
  return violations;
}

cv::Mat StrokeMask(const ColorStroke& stroke, const cv::Mat& image) {
  RequireInside(stroke, image);
  if (stroke.tool == StrokeTool::kGrow) return GrownMask(stroke, image);
  cv::Mat mask = cv::Mat::zeros(image.size(), CV_8UC1);
  if (stroke.tool == StrokeTool::kBrush) {
    DrawBrush(stroke, &mask);
  } else {
    cv::rectangle(mask, stroke.points[0], stroke.points[1], 255, cv::FILLED);
  }
  return mask;
}

}  // namespace kestrel
