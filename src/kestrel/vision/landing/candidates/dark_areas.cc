// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/candidates/dark_areas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/image/border_moments.h"
#include "kestrel/core/image/gray_sampling.h"
#include "kestrel/vision/landing/image_properties.h"
#include "kestrel/vision/landing/print_places.h"

namespace kestrel {
namespace {

// Least ellipticity of a small ring that has grown together with something beside it.
constexpr double kLeastEllipticity = 0.6;
constexpr double kMinAxisRatio = 0.15;
constexpr int kDirections = 24;  // in which an outline is sampled

ConvexHull::Points PointsOf(const BorderTracer& tracer, const Border& border) {
  return {tracer.begin(border), border.count};
}

// Samples an image along an outline. The directions are those of a circle.
class OutlineSampler {
 public:
  OutlineSampler(const cv::Mat& image, const Ellipse& outline)
      : image_(image),
        center_(outline.center.cast<float>()),
        major_((outline.semi_major * outline.major_axis()).cast<float>()),
        minor_((outline.semi_minor * outline.minor_axis()).cast<float>()) {}

  // 'scale': scale of the outline about its centre. Returns a negative value outside of the image.
  float Gray(int direction, double scale) const {
    static const std::array<Eigen::Vector2f, kDirections> kUnit = [] {
      std::array<Eigen::Vector2f, kDirections> unit;
      for (int i = 0; i < kDirections; ++i) {
        const double t = i * 2 * std::numbers::pi / kDirections;
        unit[i] = Eigen::Vector2d(std::cos(t), std::sin(t)).cast<float>();
      }
      return unit;
    }();
    const Eigen::Vector2f& unit = kUnit[direction];
    const Eigen::Vector2f place =
        center_ + static_cast<float>(scale) * (unit.x() * major_ + unit.y() * minor_);
    return SampleGray(image_, place.x(), place.y());
  }

 private:
  const cv::Mat& image_;
  Eigen::Vector2f center_, major_, minor_;
};

}  // namespace

std::optional<DarkArea> TestDarkArea(const BorderTracer& tracer, const Border& border,
                                     double min_minor_px, int max_hull_extent) {
  const int width = border.max.x - border.min.x;
  const int height = border.max.y - border.min.y;
  if (std::min(width, height) < kMinAxisRatio * std::max(width, height)) return std::nullopt;
  constexpr double kSmoothLength = 2.6;
  // The border of a convex outline is as long as its bounding box is around; noise may add some.
  const bool smooth = static_cast<double>(border.count) <= kSmoothLength * (width + height);
  RegionMoments moments;
  if (smooth) moments = ComputeBorderMoments(tracer.begin(border), border.count);
  DarkArea area;
  area.ellipticity = smooth ? moments.Ellipticity() : 0;
  if (area.ellipticity < kLeastEllipticity) {
    if (std::max(width, height) > max_hull_extent) return std::nullopt;
    moments = ComputeHullMoments(ConvexHull(PointsOf(tracer, border)));
    area.ellipticity = moments.Ellipticity();
    if (area.ellipticity < kMinEllipticity) return std::nullopt;
  }
  area.outline = EllipseFromMoments(moments);
  if (2 * area.outline.semi_minor < min_minor_px) return std::nullopt;
  area.edge = border.signed_area > 0 ? RingEdge::kOuter : RingEdge::kInner;
  return area;
}

bool IsCutOff(const BorderTracer& tracer, const Border& border) {
  return border.min.x <= 0 || border.min.y <= 0 || border.max.x >= tracer.image_size().width ||
         border.max.y >= tracer.image_size().height;
}

std::size_t OutlineInView(const BorderTracer& tracer, const Border& border,
                          std::span<Eigen::Vector2d> outline) {
  const ConvexHull hull(PointsOf(tracer, border));
  const std::span<const Eigen::Vector2d> corners = hull.corners();
  // Beyond the centres of the outermost pixels the outline already turns along the image border.
  const Eigen::Array2d last(tracer.image_size().width - 1, tracer.image_size().height - 1);
  const auto at_image_border = [&](const Eigen::Vector2d& point) {
    return (point.array() <= 0).any() || (point.array() >= last).any();
  };
  std::size_t count = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d& corner = corners[i];
    const Eigen::Vector2d side = corners[(i + 1) % corners.size()] - corner;
    const auto steps = static_cast<int>(std::ceil(side.norm()));
    for (int k = 0; k < steps && count < outline.size(); ++k) {
      const Eigen::Vector2d point = corner + (k + 0.5) / steps * side;
      if (!at_image_border(point)) outline[count++] = point;
    }
  }
  return count;
}

double RingContrast(const cv::Mat& image, const Ellipse& outer_edge,
                    const LandingPattern& pattern) {
  constexpr float kLeastOfMedian = 0.2f;
  constexpr double kOutside = 0.7;  // from the ring to the white beside it, ring widths
  const double radius = pattern.outer_radius_m();
  const double ring = 0.5 * (radius + pattern.inner_radius_m()) / radius;
  const double outside = 1 + kOutside * std::min(pattern.ring_width_m / radius,
                                                 0.5 * pattern.board_size_m / radius - 1);
  const double inside = PrintPlaces::kInside * pattern.inner_radius_m() / radius;
  const OutlineSampler sampler(image, outer_edge);
  std::array<float, kDirections> contrast;
  std::array<float, kDirections> inner_contrast;
  int seen = 0, without = 0;
  for (int i = 0; i < kDirections; ++i) {
    const float dark = sampler.Gray(i, ring);
    const float bright = sampler.Gray(i, outside);
    const float center = sampler.Gray(i, inside);
    if (dark < 0 || bright < 0 || center < 0) continue;
    contrast[seen] = bright - dark;
    inner_contrast[seen++] = center - dark;
    // A quarter of the directions may show anything, so the least contrast among the others counts.
    without += bright - dark < GrayContrast::kLeast;
    if (4 * without > kDirections) return 0;
  }
  if (2 * seen < kDirections) return 0;
  std::sort(contrast.begin(), contrast.begin() + seen);
  const float least = contrast[seen / 4];
  if (least < std::max(GrayContrast::kLeast, kLeastOfMedian * contrast[seen / 2])) return 0;
  // Inside, arms and white quadrants alternate: a quarter of the directions must show white.
  const float upper = RankedInPlace(std::span(inner_contrast).first(seen), seen - seen / 4);
  if (upper < static_cast<float>(PrintPlaces::kLeastInside) * contrast[seen / 2]) return 0;
  return least;
}

double BoardContrast(const cv::Mat& image, const Ellipse& outer_edge) {
  // Outer radii of the ring: white of the board, and the ring, whose width and place are not exact.
  constexpr double kOnBoard = 1.35;
  constexpr std::array<double, 3> kOnRing{0.8, 0.95, 1.1};
  const OutlineSampler sampler(image, outer_edge);
  std::array<float, kDirections> contrast;
  for (int i = 0; i < kDirections; ++i) {
    const float white = sampler.Gray(i, kOnBoard);
    const auto dark = [&](double scale) { return sampler.Gray(i, scale); };
    contrast[i] =
        white < 0 ? 0 : white - std::min({dark(kOnRing[0]), dark(kOnRing[1]), dark(kOnRing[2])});
  }
  const float median = MedianInPlace(contrast);
  return median > GrayContrast::kLeast ? median : 0;
}

}  // namespace kestrel
