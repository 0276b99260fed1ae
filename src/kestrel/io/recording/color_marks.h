// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/vision/objects/color/hsv.h"

namespace kestrel {

// Marked pixels of one colour in an image: a rectangle, or the pixels of a mask that are not black.
struct ColorMark {
  std::string image;  // path
  std::string color;
  cv::Rect rectangle;  // px; empty when there is a mask
  std::string mask;    // path; may be empty
};

// Parses a YAML list of {image: FILE, color: NAME, rectangle: [x, y, width, height]} or {image:
// FILE, color: NAME, mask: FILE}; paths are relative to the folder of 'file'. Throws InputError for
// entries that are missing, unknown or of the wrong type.
std::vector<ColorMark> ParseColorMarks(const std::string& yaml, const std::string& file);

// Returns the colours of the marked pixels by name. Throws InputError when an image cannot be read,
// a rectangle is not inside of the image, or a mask does not have its size.
std::map<std::string, std::vector<Hsv>> ReadMarkedColors(const std::vector<ColorMark>& marks);

}  // namespace kestrel
