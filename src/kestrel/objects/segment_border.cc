// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/objects/segment_border.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace kestrel {
namespace {

constexpr int kNone = std::numeric_limits<int>::max();

void Extend(int x, Eigen::Vector2i* extent) {
  *extent = {std::min(extent->x(), x), std::max(extent->y(), x)};
}

}  // namespace

void FindBorder(const Segment& segment, const cv::Size& image_size, SegmentBorder* border) {
  const auto is_inside = [&](const Eigen::Vector2d& p) {
    return p.x() > 1 && p.y() > 1 && p.x() < image_size.width - 2 && p.y() < image_size.height - 2;
  };
  const int height = segment.height();
  auto& extents = border->extents;
  extents.assign(height + segment.width(), Eigen::Vector2i(kNone, -kNone));
  for (const PixelPosition& at : segment.pixels) {
    Extend(at.u, &extents[at.v - segment.min_v]);
    Extend(at.v, &extents[height + at.u - segment.min_u]);
  }
  border->points.clear();
  border->cut.clear();
  const auto add = [&](const Eigen::Vector2d& point) {
    (is_inside(point) ? border->points : border->cut).push_back(point);
  };
  for (int i = 0; i < static_cast<int>(extents.size()); ++i) {
    for (const double x : {extents[i].x() - 0.5, extents[i].y() + 0.5}) {
      if (i < height) {
        add({x, segment.min_v + i});
      } else {
        add({segment.min_u + i - height, x});
      }
    }
  }
}

void AddDiagonalEnds(const Segment& segment, SegmentBorder* border) {
  // Along a falling diagonal u - v stays and u + v grows, along a rising one the other way round.
  const int count = segment.width() + segment.height();
  const int first_sum = segment.min_u + segment.min_v;
  const int first_difference = segment.min_u - segment.max_v;
  auto& extents = border->extents;
  extents.assign(2 * count, Eigen::Vector2i(kNone, -kNone));
  for (const PixelPosition& at : segment.pixels) {
    Extend(at.u + at.v, &extents[at.u - at.v - first_difference]);
    Extend(at.u - at.v, &extents[count + at.u + at.v - first_sum]);
  }
  const double half = std::numbers::sqrt2 / 2;
  for (int i = 0; i < 2 * count; ++i) {
    if (extents[i].x() == kNone) continue;
    for (const double end : {extents[i].x() - half, extents[i].y() + half}) {
      const double sum = i < count ? end : first_sum + i - count;
      const double difference = i < count ? first_difference + i : end;
      border->points.emplace_back(0.5 * (sum + difference), 0.5 * (sum - difference));
    }
  }
}

}  // namespace kestrel
