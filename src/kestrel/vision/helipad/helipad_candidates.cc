// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/helipad/helipad_candidates.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace kestrel {
namespace {

struct HelipadPass {
  int image_level;  // the image at 1 / 2^level
  int tile_level;   // tiles of 2^tile_level pixels make the threshold's box
  int min_px;       // least and largest extent of an H, full resolution
  int max_px;
};

constexpr std::array<HelipadPass, HelipadFinder::kPasses> kHelipadPasses{{
    {.image_level = 3, .tile_level = 5, .min_px = 150, .max_px = 1 << 13},
    {.image_level = 2, .tile_level = 5, .min_px = 60, .max_px = 500},
    {.image_level = 1, .tile_level = 4, .min_px = 28, .max_px = 240},
    {.image_level = 0, .tile_level = 3, .min_px = 7, .max_px = 110},
}};
// The threshold also looks at boxes four times as large.
constexpr int kLastHelipadTile = kHelipadPasses[0].tile_level + 2;

constexpr std::size_t kMostCorners = 320;  // of a border that are looked at
constexpr std::size_t kMostCandidates = 64;

Eigen::Matrix3d PlaneAcross(const Eigen::Vector3d& ray) {
  Eigen::Matrix3d axes;
  axes.col(2) = ray;
  axes.col(0) = Eigen::Vector3d::UnitX() - ray.x() * ray;
  if (axes.col(0).norm() < 0.1) axes.col(0) = Eigen::Vector3d::UnitY() - ray.y() * ray;
  axes.col(0).normalize();
  axes.col(1) = ray.cross(axes.col(0));
  return axes;
}

}  // namespace

bool HelipadFinder::Covers(int pass, double least_px, double most_px) {
  return most_px >= kHelipadPasses[pass].min_px && least_px <= kHelipadPasses[pass].max_px;
}

void HelipadFinder::Begin(const cv::Mat& image, const cv::Rect& part,
                          HelipadCandidateBuffers* buffers) const {
  if (buffers->width_px != image.cols || buffers->height_px != image.rows) {
    buffers->width_px = image.cols;
    buffers->height_px = image.rows;
    buffers->tracer.Reserve(image.cols, image.rows);
    buffers->corners.reserve(kMostCorners);
    buffers->candidates.reserve(kMostCandidates);
    // Runs the parts whose memory depends on the size alone.
    buffers->pyramid.Build(image);
    const cv::Rect whole(0, 0, image.cols, image.rows);
    for (int pass = 0; pass < kPasses; ++pass) Find(whole, pass, buffers);
  }
  buffers->pyramid.Build(image(part), kLastHelipadTile);
}

void HelipadFinder::Find(const cv::Rect& part, int pass_index,
                         HelipadCandidateBuffers* buffers) const {
  buffers->candidates.clear();
  buffers->borders = 0;
  const HelipadPass& pass = kHelipadPasses[pass_index];
  const cv::Mat at_level = buffers->pyramid.ImageAt(pass.image_level);
  if (at_level.empty() || std::max(part.width, part.height) < pass.min_px) return;
  buffers->threshold.Measure(buffers->pyramid, pass.image_level, pass.tile_level);
  constexpr int kLeastContrast = 10, kMostContrast = 28;
  const int contrast =
      std::clamp(buffers->threshold.ContrastQuantile(0.7), kLeastContrast, kMostContrast);
  buffers->threshold.Binarize(at_level, contrast, &buffers->binary);
  BorderLimits limits;
  limits.min_extent = std::max(4, pass.min_px >> (pass.image_level + 1));
  limits.min_count = 4 * static_cast<std::size_t>(limits.min_extent);
  limits.max_extent = pass.max_px >> pass.image_level;
  limits.narrow = true;
  buffers->tracer.Trace(buffers->binary, cv::Rect(0, 0, at_level.cols, at_level.rows), limits);
  const Level level{static_cast<double>(1 << pass.image_level), part.tl()};
  for (const Border& border : buffers->tracer.borders()) {
    // A border goes clockwise around a dark area, and anticlockwise around a hole in it.
    if ((border.signed_area < 0) != model_.white) continue;
    ++buffers->borders;
    if (buffers->candidates.size() == kMostCandidates) return;
    Examine(border, level, buffers);
  }
}

bool HelipadFinder::Examine(const Border& border, const Level& level,
                            HelipadCandidateBuffers* buffers) const {
  const auto on_image = [&level](double x, double y) {
    return Eigen::Vector2f(level.scale * x - 0.5 + level.origin.x,
                           level.scale * y - 0.5 + level.origin.y);
  };
  // The H fills about half of its box when that is upright, and less when it is turned.
  const double box =
      static_cast<double>(border.max.x - border.min.x) * (border.max.y - border.min.y);
  constexpr double kLeastFill = 0.2, kMostFill = 0.85;
  const double fill = std::abs(border.signed_area) / box;
  if (fill < kLeastFill || fill > kMostFill) return false;
  const Eigen::Vector2f middle =
      on_image(0.5 * (border.min.x + border.max.x), 0.5 * (border.min.y + border.max.y));
  const Eigen::Vector3d ray = rays_.Ray(middle.x(), middle.y()).cast<double>();
  if (ray.isZero()) return false;
  HelipadCandidate candidate;
  candidate.camera_from_plane = PlaneAcross(ray);
  const Eigen::Matrix3d plane_from_camera = candidate.camera_from_plane.transpose();
  const GridPoint* const points = buffers->tracer.begin(border);
  const std::size_t step = (border.count + kMostCorners - 1) / kMostCorners;
  buffers->corners.clear();
  for (std::size_t i = 0; i < border.count; i += step) {
    const GridPoint& a = points[i];
    const GridPoint& b = points[(i + 1) % border.count];
    const Eigen::Vector2f pixel = on_image(0.5 * (a.x + b.x), 0.5 * (a.y + b.y));
    const Eigen::Vector3d local =
        plane_from_camera * rays_.Ray(pixel.x(), pixel.y()).cast<double>();
    constexpr double kLeastForward = 0.2;
    if (local.z() < kLeastForward) return false;
    buffers->corners.push_back(local.hnormalized());
  }
  candidate.moments = MomentsOf(buffers->corners);
  constexpr double kTolerance = 0.3;
  const double ratio = candidate.moments.Compactness() / model_.moments.Compactness();
  if (ratio < 1 - kTolerance || ratio > 1 + kTolerance) return false;
  buffers->candidates.push_back(candidate);
  return true;
}

}  // namespace kestrel
