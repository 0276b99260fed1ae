// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace kestrel {

enum class StrokeTool {
  kBrush,      // along a line
  kRectangle,  // between two corners
  kGrow,       // pixels connected to a point with nearly its colour
};
const char* ToString(StrokeTool tool);  // "brush", "rectangle", "grow"

// Pixels that a person marks at once, and their colour.
struct ColorStroke {
  std::size_t frame = 0;  // index in the recording, from 0
  std::string color;      // name of a colour of the model; empty: none of its colours
  StrokeTool tool = StrokeTool::kBrush;
  // For a brush its radius, 0.5 to 200 px. For growing the greatest difference of a channel from
  // the point's, 1 to 100 of 255. For a rectangle 0.
  double size = 0;
  // Pixels: 1 to 1000 points of the brush's path; two opposite corners of the rectangle, which
  // belong to it; or the point to grow from.
  std::vector<cv::Point> points;

  bool operator==(const ColorStroke&) const = default;

  // Returns each violation that is visible without the image, in words.
  std::vector<std::string> Validate() const;
};

// Returns the stroke's pixels: CV_8UC1 of the image's size, 255 in the stroke, 0 elsewhere. 'image'
// is CV_8UC3, the stroke is valid. Throws InputError when one of its points lies outside of the
// image.
cv::Mat StrokeMask(const ColorStroke& stroke, const cv::Mat& image);

}  // namespace kestrel
