// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "kestrel/core/geometry/ellipse.h"
#include "kestrel/vision/objects/color/hsv.h"
#include "kestrel/vision/objects/segmentation/segmentation.h"

namespace kestrel {

// Returns pi b_u b_v / (4 s) of a segment with s pixels in a bounding box of b_u x b_v: 1 for an
// upright ellipse, more for an oblique one, 0.79 for an upright rectangle (paper, eq. 7, without
// the - 1).
double Roundness(const Segment& segment);

// Measures of a segment from the paper's Algorithm 4 and eq. 8 to 12.
struct SegmentShape {
  RegionMoments moments;  // pixels, centroid, covariance (eq. 8)
  Ellipse ellipse;        // ellipse with these moments (eq. 9 to 11), semi-axes 2 sqrt(lambda)
  double roundness = 0;
  // 4 pi sqrt(lambda_0 lambda_1) / s: 1 for a filled ellipse, 1.05 for a square, 1.21 for an
  // equilateral triangle (eq. 12, without the - 1).
  double circularity = 0;
  Hsv mean_color;
};

SegmentShape MeasureShape(const cv::Mat& image, const Segment& segment);

}  // namespace kestrel
