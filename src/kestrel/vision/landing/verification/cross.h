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
#include "kestrel/vision/landing/verification/pattern_view.h"

namespace kestrel {

// A verified cross inside of a ring (paper, section 2.4). There is one function for each size of
// the ring. All of them work on the inside of the ring, rectified to a square. The corners of the
// square lie under the ring and are ignored.
struct Cross {
  double arm_angle = 0;  // rad, direction of one arm in the plane of the view; modulo pi / 2
};

// The rectified inside of a ring, 'size' pixels across the inner diameter, with its dark pixels by
// a local threshold.
struct RingInside {
  SmallMask dark;
  SmallMask disc;  // pixels within the inner radius that are in view
  double seen;     // share of the disc in view, 0 to 1

  // Plane coordinates (unit: inner radii) of a pixel.
  double Coordinate(double index) const { return (2 * index + 1) / dark.size() - 1; }
};

// Samples 'image' over the inside of the ring. Returns nothing when less than a fifth of it is in
// view, or when its contrast is less than 'min_contrast' gray values.
std::optional<RingInside> RectifyInside(const cv::Mat& image, const PatternView& view,
                                        const LandingPattern& pattern, int size,
                                        double min_contrast);

// For rings of less than 30 px. The dark pixels are closed; the cross must then divide the disc
// into exactly four bright areas of similar size.
std::optional<Cross> FindCrossByQuadrants(const RingInside& inside);

// For rings of 30 to 150 px. After thinning (Guo and Hall 1989) the dark pixels must form two lines
// that cross near the centre at right angles. Where only a part of the disc is in view, the half
// arms in view are required, at least one.
std::optional<Cross> FindCrossByThinning(const RingInside& inside);

// For a cross that the image border cuts off or a shadow crosses. Finds the direction, modulo a
// right angle, that is darkest against what lies beside it, over the half arms in view. Returns
// nothing when no direction is darker by 'min_contrast' gray values. The result is a proposal only:
// it does not exclude another figure in the ring.
std::optional<Cross> FindCrossByProfile(const cv::Mat& image, const PatternView& view,
                                        const LandingPattern& pattern, double min_contrast);

// Memory of FindCrossByLines. Does not allocate once it is reserved.
struct CrossLinesWorkspace {
  BinaryImage binary;
  BorderTracer tracer;
  std::vector<Eigen::Vector2d> border;
  std::vector<std::size_t> breaks;
  std::vector<LineSegment> segments;

  void Reserve();
};

// For rings of more than 150 px. The borders of the dark pixels, split and merged into straight
// lines, must contain two pairs of parallel lines at right angles, each pair an arm's width apart.
std::optional<Cross> FindCrossByLines(const RingInside& inside, const LandingPattern& pattern,
                                      CrossLinesWorkspace* workspace);

}  // namespace kestrel
