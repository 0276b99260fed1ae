// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/vision/objects/segmentation/segmentation.h"

namespace kestrel {

// Points on the border of a segment (px): the outermost pixels of each row and column, moved
// outwards by half a pixel.
struct SegmentBorder {
  std::vector<Eigen::Vector2d> points;
  std::vector<Eigen::Vector2d> cut;      // points where the image border ends the segment
  std::vector<Eigen::Vector2i> extents;  // memory: first and last of each row, then of each column
};

// Overwrites 'border'. Allocates only for segments larger than any before.
void FindBorder(const Segment& segment, const cv::Size& image_size, SegmentBorder* border);

// The same for the centres of the border pixels, with all of them in 'points'.
void FindBorderPixels(const Segment& segment, SegmentBorder* border);

// Adds the ends of the diagonals to 'points'. Rows and columns miss some notches, like that between
// two discs of which one is up and to the right of the other.
void AddDiagonalEnds(const Segment& segment, SegmentBorder* border);

}  // namespace kestrel
