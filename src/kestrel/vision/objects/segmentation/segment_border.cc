// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/segmentation/segment_border.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace kestrel {
namespace {

constexpr int kNone = std::numeric_limits<int>::max();

void Extend(int x, Eigen::Vector2i* extent) {
  *extent = {std::min(extent->x(), x), std::max(extent->y(), x)};
}

// Calls 'visit' with the outermost pixels of each row and column and the outward direction.
template <class Visit>
void VisitEnds(const Segment& segment, std::vector<Eigen::Vector2i>* extents, const Visit& visit) {
  const int height = segment.height();
  extents->assign(height + segment.width(), Eigen::Vector2i(kNone, -kNone));
  for (const PixelPosition& at : segment.pixels) {
    Extend(at.u, &(*extents)[at.v - segment.min_v]);
    Extend(at.v, &(*extents)[height + at.u - segment.min_u]);
  }
  for (int i = 0; i < static_cast<int>(extents->size()); ++i) {
    for (const int side : {0, 1}) {
      const double end = (*extents)[i][side];
      const double outward = 2 * side - 1;
      if (i < height) {
        visit(Eigen::Vector2d(end, segment.min_v + i), Eigen::Vector2d(outward, 0));
      } else {
        visit(Eigen::Vector2d(segment.min_u + i - height, end), Eigen::Vector2d(0, outward));
      }
    }
  }
}

}  // namespace

void FindBorder(const Segment& segment, const cv::Size& image_size, SegmentBorder* border) {
  const auto is_inside = [&](const Eigen::Vector2d& p) {
    return p.x() > 1 && p.y() > 1 && p.x() < image_size.width - 2 && p.y() < image_size.height - 2;
  };
  border->points.clear();
  border->cut.clear();
  VisitEnds(segment, &border->extents,
            [&](const Eigen::Vector2d& pixel, const Eigen::Vector2d& outward) {
              const Eigen::Vector2d point = pixel + 0.5 * outward;
              (is_inside(point) ? border->points : border->cut).push_back(point);
            });
}

void FindBorderPixels(const Segment& segment, SegmentBorder* border) {
  border->points.clear();
  border->cut.clear();
  VisitEnds(segment, &border->extents, [&](const Eigen::Vector2d& pixel, const Eigen::Vector2d&) {
    border->points.push_back(pixel);
  });
}

void AddDiagonalEnds(const Segment& segment, SegmentBorder* border) {
  // Along a falling diagonal u - v is constant and u + v grows; along a rising one it is the
  // reverse.
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
