// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/segmentation/segment_shape.h"

#include <array>
#include <cstdint>
#include <numbers>

namespace kestrel {

double Roundness(const Segment& segment) {
  return std::numbers::pi * segment.width() * segment.height() /
         (4 * static_cast<double>(segment.pixels.size()));
}

SegmentShape MeasureShape(const cv::Mat& image, const Segment& segment) {
  std::int64_t u_sum = 0;
  std::int64_t v_sum = 0;
  std::int64_t uu = 0;
  std::int64_t uv = 0;
  std::int64_t vv = 0;
  std::array<std::int64_t, 3> bgr{};
  const std::size_t colored = segment.pixels.size() - segment.ambiguous_pixels;
  for (std::size_t i = 0; i < segment.pixels.size(); ++i) {
    const PixelPosition& at = segment.pixels[i];
    // Relative to the corner of the bounding box, to keep the precision of the squares.
    const std::int64_t u = at.u - segment.min_u;
    const std::int64_t v = at.v - segment.min_v;
    u_sum += u;
    v_sum += v;
    uu += u * u;
    uv += u * v;
    vv += v * v;
    if (i >= colored) continue;
    const std::uint8_t* pixel = image.ptr(at.v) + 3 * at.u;
    for (int channel = 0; channel < 3; ++channel) bgr[channel] += pixel[channel];
  }
  const auto s = static_cast<double>(segment.pixels.size());
  const Eigen::Vector2d mean(u_sum / s, v_sum / s);
  SegmentShape shape;
  shape.moments.area = s;
  shape.moments.centroid = mean + Eigen::Vector2d(segment.min_u, segment.min_v);
  shape.moments.covariance << uu / s, uv / s, uv / s, vv / s;
  shape.moments.covariance -= mean * mean.transpose();
  shape.ellipse = EllipseFromMoments(shape.moments);
  shape.roundness = Roundness(segment);
  shape.circularity = 1 / shape.moments.Ellipticity();
  const auto n = static_cast<float>(colored);
  shape.mean_color = HsvFromBgr(bgr[0] / n, bgr[1] / n, bgr[2] / n);
  return shape;
}

}  // namespace kestrel
