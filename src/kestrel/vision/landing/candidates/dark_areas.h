// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <opencv2/core.hpp>

#include "kestrel/core/geometry/ellipse.h"
#include "kestrel/core/image/border_tracing.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

// The edge of the ring that a curve is taken for.
enum class RingEdge { kOuter, kInner };

// A closed border that may be an edge of the ring. Pixels of the image in which it was traced.
struct DarkArea {
  Ellipse outline;  // ellipse with the second moments of the enclosed area
  RingEdge edge;
  double ellipticity;  // RegionMoments::Ellipticity
};

// Least ellipticity of an outline that is an ellipse or a parallelogram. The lens's bend and the
// corners of the pixels stay within this.
inline constexpr double kMinEllipticity = 0.9;

// Tests whether a border may be an edge of the ring: the paper's continuous dark areas with convex
// border (section 2.1). Uses moments only, before anything is fitted: the outline must enclose
// nearly as much as an ellipse with the same second moments, and be at least 'min_minor_px' across.
// The outer border of an area is taken for the outer edge of the ring, the border of a hole for the
// inner one. The stroke of a small ring is hardly wider than the blur, so a gap may let the border
// in. For borders that are not convex and at most 'max_hull_extent' pixels wide and high the convex
// hull is therefore tested instead.
std::optional<DarkArea> TestDarkArea(const BorderTracer& tracer, const Border& border,
                                     double min_minor_px, int max_hull_extent = 0);

// True when a border touches the image border.
bool IsCutOff(const BorderTracer& tracer, const Border& border);

// Writes the part of a border's convex hull that is in view to 'outline': points at most a pixel
// apart, between the centres of the outermost pixels, as many as 'outline' has room for. Returns
// their number. The border must be at most ConvexHull::kMaxHeight pixels high.
std::size_t OutlineInView(const BorderTracer& tracer, const Border& border,
                          std::span<Eigen::Vector2d> outline);

// Returns the contrast of the ring along an outline, gray values: black against the white around it
// and the white inside, the value that three of four directions reach; 0 when the ring does not
// stand out. 'image': the one in which the border was traced. Costs less than a tenth of fitting a
// ring.
double RingContrast(const cv::Mat& image, const Ellipse& outer_edge, const LandingPattern& pattern);

// Returns how much darker, gray values, an image is on a ring than outside of it, in at least half
// of the directions; 0 when it is not. Meant for rings that are predicted by the board and may be
// broken.
double BoardContrast(const cv::Mat& image, const Ellipse& outer_edge);

}  // namespace kestrel
