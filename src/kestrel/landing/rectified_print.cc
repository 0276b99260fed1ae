// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/rectified_print.h"

#include <algorithm>
#include <array>

namespace kestrel {
namespace {

constexpr int kSidePx = 40;       // the ring is as large as a small one may be
constexpr double kExtent = 1.46;  // half a side, outer radii of the ring

// Sees the square from a height of half its side.
CameraIntrinsics CameraAbove() {
  constexpr double kMiddle = 0.5 * (kSidePx - 1);
  CameraIntrinsics camera;
  camera.width_px = camera.height_px = kSidePx;
  camera.fx_px = camera.fy_px = 0.5 * kSidePx;
  camera.cx_px = camera.cy_px = kMiddle;
  return camera;
}

RigidTransform PoseBelow(double height_m) {
  return {Eigen::Quaterniond(0, 1, 0, 0), {0, 0, height_m}};
}

}  // namespace

RectifiedPrint::RectifiedPrint(const LandingPattern& pattern)
    : extent_m_(kExtent * pattern.outer_radius_m()),
      camera_(CameraAbove()),
      rays_(camera_),
      fitter_(camera_, rays_, pattern) {}

void RectifiedPrint::Rectify(const cv::Mat& image, const PatternView& view,
                             RectifiedPrintBuffers* buffers) const {
  buffers->gray.create(kSidePx, kSidePx, CV_8UC1);
  buffers->seen.create(kSidePx, kSidePx, CV_8UC1);
  const auto at = [this](int index) {
    return static_cast<float>((2.0 * index + 1 - kSidePx) / kSidePx * extent_m_);
  };
  std::array<float, kSidePx> x_m, y_m, gray;
  for (int i = 0; i < kSidePx; ++i) x_m[i] = at(i);
  for (int row = 0; row < kSidePx; ++row) {
    y_m.fill(-at(row));
    view.Sample(image, x_m.data(), y_m.data(), kSidePx, gray.data());
    for (int i = 0; i < kSidePx; ++i) {
      const bool is_seen = gray[i] >= 0;
      buffers->seen.at<std::uint8_t>(row, i) = is_seen ? 255 : 0;
      buffers->gray.at<std::uint8_t>(row, i) =
          is_seen ? cv::saturate_cast<std::uint8_t>(gray[i]) : 0;
    }
  }
}

std::optional<SmallPatternFitter::Fit> RectifiedPrint::Compare(
    const RectifiedPrintBuffers& buffers, SmallPatternFitter::Light light,
    SmallPatternWorkspace* workspace) const {
  constexpr int kIterations = 3;  // for the light and the blur, the place is known
  return fitter_.Refine({buffers.gray, &buffers.seen}, PoseBelow(extent_m_), light, kIterations,
                        workspace);
}

}  // namespace kestrel
