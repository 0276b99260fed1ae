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
  kGrow,       // what is joined to a point and has nearly its colour
};
const char* ToString(StrokeTool tool);  // "brush", "rectangle", "grow"

// Pixels that a person marks at once, and as what.
struct ColorStroke {
  std::size_t frame = 0;  // number in the recording, from 0
  std::string color;      // name of a colour of the model; empty: none of its colours
  StrokeTool tool = StrokeTool::kBrush;
  // Of a brush its radius, 0.5 to 200 px; of growing how much a channel may differ from that of the
  // point, 1 to 100 of 255; of a rectangle 0.
  double size = 0;
  // Pixels: the brush's way, 1 to 1000 of them; the rectangle's opposite corners, which belong to
  // it; the point to grow from.
  std::vector<cv::Point> points;

  bool operator==(const ColorStroke&) const = default;

  // Every violation in words, of what can be told without the image.
  std::vector<std::string> Validate() const;
};

// The stroke's pixels: CV_8UC1 of the image's size, 255 in the stroke, 0 elsewhere. 'image' is
// CV_8UC3, the stroke valid. Throws InputError when one of its points lies outside of the image.
cv::Mat StrokeMask(const ColorStroke& stroke, const cv::Mat& image);

}  // namespace kestrel
