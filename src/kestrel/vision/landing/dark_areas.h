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

// Which edge of the ring a curve is taken for.
enum class RingEdge { kOuter, kInner };

// A closed border that may be an edge of the ring, in pixels of the image it was traced in.
struct DarkArea {
  Ellipse outline;  // with the second moments of what the border encloses
  RingEdge edge;
  double ellipticity;  // RegionMoments::Ellipticity
};

// Ellipticity of an outline that is an ellipse or a parallelogram: what the lens bends and the
// corners of the pixels cost stays within this.
inline constexpr double kMinEllipticity = 0.9;

// The paper's continuous dark areas with convex border (section 2.1), tested by their moments
// alone, before anything is fitted: the outline encloses as much as an ellipse with the same second
// moments, and is not thinner than 'min_minor_px' across. The outer border of an area is taken for
// the outer edge of the ring, the border of a hole for the inner one. Where the stroke of a small
// ring is hardly wider than the blur, the border enters it through a gap: of borders that are at
// most 'max_hull_extent' pixels wide and high and not convex, the convex hull is tested instead.
std::optional<DarkArea> TestDarkArea(const BorderTracer& tracer, const Border& border,
                                     double min_minor_px, int max_hull_extent = 0);

// Whether a border touches that of the image.
bool IsCutOff(const BorderTracer& tracer, const Border& border);

// What the image shows of the convex hull of a border that is at most ConvexHull::kMaxHeight pixels
// high: writes the points of it that lie between the centres of the outermost pixels to 'outline',
// as many as there is room for and a pixel or less apart, and returns how many.
std::size_t OutlineInView(const BorderTracer& tracer, const Border& border,
                          std::span<Eigen::Vector2d> outline);

// How well the ring stands out along an outline, gray values: the least contrast, in three of four
// directions, of the black between the white around it and the white inside; 0 when it does not.
// 'image': the one in which the border was traced. Costs less than a tenth of fitting a ring.
double RingContrast(const cv::Mat& image, const Ellipse& outer_edge, const LandingPattern& pattern);

// How much darker, gray values, an image is near a ring than outside of it, in half of the
// directions at least; 0 when it is not. For rings that the board shows and that may be broken.
double BoardContrast(const cv::Mat& image, const Ellipse& outer_edge);

}  // namespace kestrel
