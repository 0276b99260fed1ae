// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/image/border_tracing.h"
#include "kestrel/core/image/local_threshold.h"
#include "kestrel/core/image/polyline.h"
#include "kestrel/core/image/small_mask.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/pattern_view.h"

namespace kestrel {

// What verifies a cross inside of a ring (paper, section 2.4): one function for each size of the
// ring. All work on the inside of the ring rectified to a square; the corners of the square lie
// under the ring and are not looked at.
struct Cross {
  double arm_angle = 0;  // rad, of one arm in the plane of the view; modulo pi / 2
};

// The rectified inside of a ring, of 'size' pixels across the inner diameter: which pixels are
// dark, by a local threshold.
struct RingInside {
  SmallMask dark;
  SmallMask disc;  // pixels within the inner radius that the image shows
  double seen;     // share of the disc that the image shows

  // Plane coordinates (unit: inner radii) of a pixel.
  double Coordinate(double index) const { return (2 * index + 1) / dark.size() - 1; }
};

// Samples 'image' over the inside of the ring. Nothing when the image shows less than a fifth of it
// or it has less contrast than 'min_contrast' gray values.
std::optional<RingInside> RectifyInside(const cv::Mat& image, const PatternView& view,
                                        const LandingPattern& pattern, int size,
                                        double min_contrast);

// Rings of less than 30 px: the cross divides the disc into exactly four bright areas of similar
// size, after closing the dark ones.
std::optional<Cross> FindCrossByQuadrants(const RingInside& inside);

// Rings of 30 to 150 px: thinned by Guo and Hall's method, the dark pixels leave two lines that
// cross near the centre at right angles. Where the image shows only a part of the disc, the half
// arms that it shows are asked for, at least one.
std::optional<Cross> FindCrossByThinning(const RingInside& inside);

// Where a cross is cut off by the image border or crossed by a shadow: the direction, modulo a
// right angle, along which the image is darkest beside what lies next to it, by the half arms that
// it shows. Nothing when no direction is darker by 'min_contrast' gray values. A proposal: it does
// not say that nothing else is in the ring.
std::optional<Cross> FindCrossByProfile(const cv::Mat& image, const PatternView& view,
                                        const LandingPattern& pattern, double min_contrast);

// Memory of FindCrossByLines, which does not allocate once it is reserved.
struct CrossLinesWorkspace {
  BinaryImage binary;
  BorderTracer tracer;
  std::vector<Eigen::Vector2d> border;
  std::vector<std::size_t> breaks;
  std::vector<LineSegment> segments;

  void Reserve();
};

// Rings of more than 150 px: the border of the dark area, split and merged into straight lines, has
// two pairs of parallels at right angles, each an arm's width apart.
std::optional<Cross> FindCrossByLines(const RingInside& inside, const LandingPattern& pattern,
                                      CrossLinesWorkspace* workspace);

}  // namespace kestrel
