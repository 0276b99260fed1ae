// SPDX-License-Identifier: BSD-3-Clause
// The pixels that show a small print, and their rays.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "kestrel/vision/landing/small_pattern/small_pattern_model.h"

namespace kestrel {
namespace {

constexpr std::size_t kMinPixels = 30;
constexpr int kMaxSide = 256;  // largest side of the box around the print, pixels

}  // namespace

SmallPatternWorkspace::SmallPatternWorkspace() {
  constexpr std::size_t kVector = 64;                                  // at most, floats
  constexpr std::size_t kMost = 2 * kEnoughPixels + 2 * kMaxSide + 1;  // pixels of box and border
  const auto make_room = [](auto&... columns) { (columns.resize(kMost + kVector), ...); };
  for (auto* rays : {&pixels.ray, &pixels.ray_by_u, &pixels.ray_by_v}) {
    for (Column& column : *rays) make_room(column);
  }
  make_room(pixels.gray, u, v, magnitudes, light);
  make_room(patch.gray, patch.print, patch.dilated);
  patch.is_print.resize(kMost);
  make_room(points.x, points.y, points.x_by_u, points.x_by_v, points.y_by_u, points.y_by_v);
  make_room(points.dark, points.ring, points.arm_x, points.arm_y);
  make_room(points.dark_by_x, points.dark_by_y, points.dark_by_log_blur);
  make_room(points.expected, points.seen, points.residual, points.weight, points.root_weight);
  for (Column& column : jacobian) make_room(column);
}

// The box of the disc under a pose; nothing where it is not in view, or too large to be small.
std::optional<SmallPatternFitter::PixelBox> SmallPatternFitter::BoxAround(
    const RigidTransform& pose, const cv::Size& image) const {
  constexpr int kCorners = 8;                  // corners of an octagon around the circle
  constexpr double kCornerRadius = 1.0823922;  // in radii of the circle
  constexpr int kMinSide = 4;
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  Eigen::AlignedBox2d around;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = i * (2 * std::numbers::pi / kCorners);
    const double reach = extent_m_ * kCornerRadius;
    Eigen::Vector2d pixel;
    if (camera_.Project(pose.translation + reach * (std::cos(angle) * rotation.col(0) +
                                                    std::sin(angle) * rotation.col(1)),
                        &pixel) == ProjectionStatus::kOutsideModel) {
      return std::nullopt;
    }
    around.extend(pixel);
  }
  const Eigen::Vector2d low = around.min(), high = around.max();
  const PixelBox box{std::max(0, static_cast<int>(std::floor(low.x()))),
                     std::max(0, static_cast<int>(std::floor(low.y()))),
                     std::min(image.width - 1, static_cast<int>(std::ceil(high.x()))),
                     std::min(image.height - 1, static_cast<int>(std::ceil(high.y())))};
  const auto [shorter, longer] = std::minmax({box.right - box.left, box.bottom - box.top});
  if (shorter < kMinSide || longer > kMaxSide) return std::nullopt;
  return box;
}

// Collects the pixels that show the disc of the print and the white around it under 'pose'. Where
// their box has more than 'enough_pixels', takes only every second, third, ... pixel of every such
// row.
bool SmallPatternFitter::Gather(const cv::Mat& image, const RigidTransform& pose, int enough_pixels,
                                SmallPatternWorkspace* workspace) const {
  workspace->count = 0;
  const std::optional<PixelBox> box = BoxAround(pose, image.size());
  if (!box) return false;
  const int width = box->right - box->left, height = box->bottom - box->top;
  const int stride =
      1 + static_cast<int>(std::sqrt(width * height / static_cast<double>(enough_pixels)));
  SmallPatternWorkspace::Patch& patch = workspace->patch;
  patch.left = box->left;
  patch.top = box->top;
  patch.stride = stride;
  patch.width = width / stride + 1;
  patch.height = height / stride + 1;
  for (int y = box->top; y <= box->bottom; y += stride) {
    for (int x = box->left; x <= box->right; x += stride) {
      workspace->u[workspace->count] = static_cast<float>(x);
      workspace->v[workspace->count++] = static_cast<float>(y);
    }
  }
  FindRays(workspace, &workspace->pixels.ray);
  KeepPixelsOfPrint(image, pose, workspace);
  DifferentiateRays(workspace);
  return workspace->count >= kMinPixels;
}

void SmallPatternFitter::FindRays(SmallPatternWorkspace* workspace,
                                  std::array<SmallPatternWorkspace::Column, 3>* columns) const {
  rays_.Rays(workspace->u.data(), workspace->v.data(), workspace->count, (*columns)[0].data(),
             (*columns)[1].data(), (*columns)[2].data());
}

// Keeps the pixels whose rays meet the disc.
void SmallPatternFitter::KeepPixelsOfPrint(const cv::Mat& image, const RigidTransform& pose,
                                           SmallPatternWorkspace* workspace) const {
  SmallPatternWorkspace::Pixels& pixels = workspace->pixels;
  const Eigen::Matrix3f plane_from_ray = PlaneFromRay(pose).cast<float>();
  const auto extent = static_cast<float>(extent_m_ * extent_m_);
  const std::size_t in_box = workspace->count;
  std::size_t count = 0;
  for (std::size_t i = 0; i < in_box; ++i) {
    const Eigen::Vector3f ray(pixels.ray[0][i], pixels.ray[1][i], pixels.ray[2][i]);
    const Eigen::Vector3f h = plane_from_ray * ray;
    const int row = static_cast<int>(workspace->v[i]), column = static_cast<int>(workspace->u[i]);
    if (!(h.z() > 0) || h.head<2>().squaredNorm() > extent * h.z() * h.z()) continue;
    for (int k = 0; k < 3; ++k) pixels.ray[k][count] = ray(k);
    pixels.gray[count] = image.ptr(row)[column];
    workspace->u[count] = workspace->u[i];
    workspace->v[count++] = workspace->v[i];
  }
  workspace->count = count;
}

// One-sided differences suffice: they only determine how far the blur reaches.
void SmallPatternFitter::DifferentiateRays(SmallPatternWorkspace* workspace) const {
  SmallPatternWorkspace::Pixels& pixels = workspace->pixels;
  const std::size_t count = workspace->count;
  const auto differences = [&](SmallPatternWorkspace::Column* place,
                               std::array<SmallPatternWorkspace::Column, 3>* columns) {
    for (std::size_t i = 0; i < count; ++i) (*place)[i] += 1;
    FindRays(workspace, columns);
    for (std::size_t i = 0; i < count; ++i) (*place)[i] -= 1;
    for (int k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < count; ++i) (*columns)[k][i] -= pixels.ray[k][i];
    }
  };
  differences(&workspace->u, &pixels.ray_by_u);
  differences(&workspace->v, &pixels.ray_by_v);
}

}  // namespace kestrel
