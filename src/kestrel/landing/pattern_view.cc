// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/pattern_view.h"

#include <algorithm>

#include "kestrel/image/gray_sampling.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/landing/pattern_view.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Pixels of 'count' points of the plane, bilinear between those of 'side' x 'side' nodes, the first
// of which lies at 'first' on both axes.
void InterpolateNodes(const float* nodes_x, const float* nodes_y, int side, float first,
                      float nodes_per_m, const float* x_m, const float* y_m, std::size_t count,
                      float* x_px, float* y_px) {
  const auto interpolate = [&](auto d, std::size_t i) HWY_ATTR {
    const hn::RebindToSigned<decltype(d)> di;
    const auto scale = hn::Set(d, nodes_per_m);
    const auto column = hn::Mul(hn::Sub(hn::LoadU(d, x_m + i), hn::Set(d, first)), scale);
    const auto row = hn::Mul(hn::Sub(hn::LoadU(d, y_m + i), hn::Set(d, first)), scale);
    const auto last = hn::Set(di, side - 2);
    const auto zero = hn::Zero(di);
    const auto column0 = hn::Max(hn::Min(hn::ConvertTo(di, column), last), zero);
    const auto row0 = hn::Max(hn::Min(hn::ConvertTo(di, row), last), zero);
    const auto along = hn::Sub(column, hn::ConvertTo(d, column0));
    const auto down = hn::Sub(row, hn::ConvertTo(d, row0));
    const auto node = hn::Add(hn::Mul(row0, hn::Set(di, side)), column0);
    const auto between = [&](const float* nodes) HWY_ATTR {
      const auto mix = [&](auto share, auto a, auto b)
                           HWY_ATTR { return hn::MulAdd(share, hn::Sub(b, a), a); };
      const auto upper =
          mix(along, hn::GatherIndex(d, nodes, node), hn::GatherIndex(d, nodes + 1, node));
      const auto lower = mix(along, hn::GatherIndex(d, nodes + side, node),
                             hn::GatherIndex(d, nodes + side + 1, node));
      return mix(down, upper, lower);
    };
    hn::StoreU(between(nodes_x), d, x_px + i);
    hn::StoreU(between(nodes_y), d, y_px + i);
  };
  const hn::CappedTag<float, 8> d;
  const std::size_t lanes = hn::Lanes(d);
  if (count < lanes) {
    for (std::size_t i = 0; i < count; ++i) interpolate(hn::CappedTag<float, 1>(), i);
    return;
  }
  for (std::size_t i = 0; i + lanes <= count; i += lanes) interpolate(d, i);
  // The last vector overlaps the one before it: some points are computed twice.
  interpolate(d, count - lanes);
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kestrel {

HWY_EXPORT(InterpolateNodes);

PatternView::PatternView(const CameraModel& camera, const RigidTransform& camera_from_pattern,
                         double extent_m, const ImageRegion& region)
    : PatternView(PlaneWarp(camera, camera_from_pattern, extent_m), extent_m, region) {}

PatternView::PatternView(const PlaneWarp& warp, double extent_m, const ImageRegion& region)
    : extent_m_(static_cast<float>(extent_m)),
      nodes_per_m_(static_cast<float>((kNodes - 1) / (2 * extent_m))) {
  for (int iy = 0; iy < kNodes; ++iy) {
    for (int ix = 0; ix < kNodes; ++ix) {
      const double x = extent_m * (2.0 * ix / (kNodes - 1) - 1);
      const double y = extent_m * (2.0 * iy / (kNodes - 1) - 1);
      Eigen::Vector2d pixel;
      if (!warp.Project({x, y}, &pixel)) {
        valid_ = false;
        return;
      }
      const Eigen::Vector2f node = region.FromFull(pixel).cast<float>();
      nodes_x_[iy * kNodes + ix] = node.x();
      nodes_y_[iy * kNodes + ix] = node.y();
    }
  }
}

void PatternView::Project(const float* x_m, const float* y_m, std::size_t count, float* x_px,
                          float* y_px) const {
  HWY_DYNAMIC_DISPATCH(InterpolateNodes)
  (nodes_x_.data(), nodes_y_.data(), kNodes, -extent_m_, nodes_per_m_, x_m, y_m, count, x_px, y_px);
}

void PatternView::Sample(const cv::Mat& image, const float* x_m, const float* y_m,
                         std::size_t count, float* gray) const {
  constexpr std::size_t kBlock = 64;
  std::array<float, kBlock> x_px, y_px;
  for (std::size_t i = 0; i < count; i += kBlock) {
    const std::size_t block = std::min(kBlock, count - i);
    Project(x_m + i, y_m + i, block, x_px.data(), y_px.data());
    SampleGrays(image, x_px.data(), y_px.data(), block, gray + i);
  }
}

}  // namespace kestrel
#endif  // HWY_ONCE
