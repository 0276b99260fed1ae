// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/objects/segment_border.h"

#include <algorithm>
#include <limits>

namespace kestrel {

void FindBorder(const Segment& segment, const cv::Size& image_size, SegmentBorder* border) {
  constexpr int kNone = std::numeric_limits<int>::max();
  const auto is_inside = [&](const Eigen::Vector2d& p) {
    return p.x() > 1 && p.y() > 1 && p.x() < image_size.width - 2 && p.y() < image_size.height - 2;
  };
  const int height = segment.height();
  auto& extents = border->extents;
  extents.assign(height + segment.width(), Eigen::Vector2i(kNone, -kNone));
  for (const PixelPosition& at : segment.pixels) {
    const auto extend = [](Eigen::Vector2i& extent, int x) {
      extent = {std::min(extent.x(), x), std::max(extent.y(), x)};
    };
    extend(extents[at.v - segment.min_v], at.u);
    extend(extents[height + at.u - segment.min_u], at.v);
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

}  // namespace kestrel
