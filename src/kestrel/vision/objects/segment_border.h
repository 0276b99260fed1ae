// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/vision/objects/segmentation.h"

namespace kestrel {

// Points on the border of a segment (px): of each row and column the outermost pixels, half a pixel
// further out.
struct SegmentBorder {
  std::vector<Eigen::Vector2d> points;
  std::vector<Eigen::Vector2d> cut;  // where it is the border of the image that ends the segment
  std::vector<Eigen::Vector2i> extents;  // memory: first and last of the rows, then of the columns
};

// Overwrites 'border'; allocates only for segments that are larger than any before.
void FindBorder(const Segment& segment, const cv::Size& image_size, SegmentBorder* border);

// The same, but the pixels themselves, and all in 'points'.
void FindBorderPixels(const Segment& segment, SegmentBorder* border);

// Adds the ends of the diagonals to 'points': what rows and columns do not see into, like the notch
// between two discs one of which is up and to the right of the other.
void AddDiagonalEnds(const Segment& segment, SegmentBorder* border);

}  // namespace kestrel
