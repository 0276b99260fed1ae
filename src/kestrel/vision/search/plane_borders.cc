// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/search/plane_borders.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "kestrel/core/image/log_gray.h"

namespace kestrel {
namespace {

constexpr std::size_t kMostPoints = 320;  // points used of a border
constexpr int kLargerTiles = 2;           // the threshold also looks at boxes four times as large

Eigen::Matrix3d AxesAcross(const Eigen::Vector3d& ray) {
  Eigen::Matrix3d axes;
  axes.col(2) = ray;
  axes.col(0) = Eigen::Vector3d::UnitY().cross(ray);
  if (axes.col(0).norm() < 0.1) axes.col(0) = Eigen::Vector3d::UnitX();
  axes.col(0) = (axes.col(0) - axes.col(0).dot(ray) * ray).normalized();
  axes.col(1) = ray.cross(axes.col(0));
  return axes;
}

// Makes the row above an image bright, so that what is dark in its first row has a border there.
void BrightenAbove(BitImage* bright) {
  std::uint64_t* const row = bright->row(-1);
  const int last = bright->words_per_row() - 1;
  std::fill_n(row, last, ~std::uint64_t{0});
  row[last] = (std::uint64_t{1} << (bright->width() % 64)) - 1;
}

cv::Mat Inverted(const cv::Mat& image, std::vector<std::uint8_t>* memory) {
  cv::Mat inverted(image.size(), CV_8UC1, memory->data());
  for (int y = 0; y < image.rows; ++y) {
    const std::uint8_t* const from = image.ptr(y);
    std::transform(from, from + image.cols, inverted.ptr(y),
                   [](std::uint8_t gray) { return static_cast<std::uint8_t>(255 - gray); });
  }
  return inverted;
}

}  // namespace

bool BorderBuffers::ShowsGlare() const {
  constexpr int kLevel = 1;  // areas of 2 x 2 pixels: one alone may be noise
  constexpr float kOverexposed = 250;
  static const auto kLeast = static_cast<std::uint8_t>(255 * LogGrays()(kOverexposed));
  return std::ranges::any_of(pyramid.level(kLevel).minimum,
                             [](std::uint8_t darkest) { return darkest >= kLeast; });
}

void NarrowBorderBuffers::Reserve(const cv::Mat& image, BorderBuffers* borders) {
  inverted.resize(image.total());
  top_hat.Binarize(image, 1, &borders->binary);
}

std::span<const Border> TraceNarrow(int level, bool white_ink, const BorderLimits& limits,
                                    BorderBuffers* borders, NarrowBorderBuffers* buffers) {
  constexpr int kLeastContrast = 16;  // gray values, of 255
  const cv::Mat image = borders->pyramid.ImageAt(level);
  if (image.empty()) return {};
  buffers->top_hat.Binarize(white_ink ? Inverted(image, &buffers->inverted) : image, kLeastContrast,
                            &borders->binary);
  borders->tracer.Trace(borders->binary, cv::Rect(0, 0, image.cols, image.rows), limits);
  return borders->tracer.borders();
}

bool PlaneBorders::Covers(int pass, double least_px, double most_px) const {
  return most_px >= passes_[pass].min_px && least_px <= passes_[pass].max_px;
}

void PlaneBorders::Begin(const cv::Mat& image, const cv::Rect& part, BorderBuffers* buffers) const {
  if (buffers->width_px != image.cols || buffers->height_px != image.rows) {
    buffers->width_px = image.cols;
    buffers->height_px = image.rows;
    buffers->tracer.Reserve(image.cols, image.rows);
    buffers->points.reserve(kMostPoints);
    buffers->log_grays.resize(image.total());
    // Runs the parts whose memory depends on the size alone.
    const cv::Rect whole(0, 0, image.cols, image.rows);
    buffers->pyramid.Build(image);
    for (int pass = 0; pass < kPasses; ++pass) Trace(whole, pass, buffers);
  }
  BuildPyramid(WriteLogGrays(image(part), buffers->log_grays.data()), buffers);
}

void PlaneBorders::BeginLinear(const cv::Mat& image, const cv::Rect& part,
                               BorderBuffers* buffers) const {
  BuildPyramid(image(part), buffers);
}

void PlaneBorders::BuildPyramid(const cv::Mat& grays, BorderBuffers* buffers) const {
  buffers->pyramid.Build(grays, passes_[0].tile_level + kLargerTiles);
}

std::span<const Border> PlaneBorders::Trace(const cv::Rect& part, int pass_index,
                                            BorderBuffers* buffers) const {
  const BorderPass& pass = passes_[pass_index];
  const cv::Mat at_level = buffers->pyramid.ImageAt(pass.image_level);
  if (at_level.empty() || std::max(part.width, part.height) < pass.min_px) return {};
  buffers->threshold.Measure(buffers->pyramid, pass.image_level, pass.tile_level);
  constexpr int kLeastContrast = 10, kMostContrast = 28;
  const int contrast =
      std::clamp(buffers->threshold.ContrastQuantile(0.7), kLeastContrast, kMostContrast);
  buffers->threshold.Binarize(at_level, contrast, &buffers->binary);
  if (pass.at_rim) BrightenAbove(&buffers->binary.bright);
  BorderLimits limits;
  limits.min_extent = pass.least_extent;
  limits.min_count = 4 * static_cast<std::size_t>(limits.min_extent);
  limits.max_extent = pass.max_px >> pass.image_level;
  limits.narrow = true;
  buffers->tracer.Trace(buffers->binary, cv::Rect(0, 0, at_level.cols, at_level.rows), limits);
  return buffers->tracer.borders();
}

bool PlaneBorders::OnPlane(const Border& border, const cv::Rect& part, int level,
                           Eigen::Matrix3d* camera_from_plane, BorderBuffers* buffers) const {
  const auto ray_at = [this, &part, scale = 1 << level](double x, double y) {
    const Eigen::Vector2f pixel(scale * x - 0.5 + part.x, scale * y - 0.5 + part.y);
    return rays_.Ray(pixel.x(), pixel.y()).cast<double>().eval();
  };
  const Eigen::Vector3d middle =
      ray_at(0.5 * (border.min.x + border.max.x), 0.5 * (border.min.y + border.max.y));
  if (middle.isZero()) return false;
  *camera_from_plane = AxesAcross(middle);
  const Eigen::Matrix3d plane_from_camera = camera_from_plane->transpose();
  const GridPoint* const points = buffers->tracer.begin(border);
  const std::size_t step = (border.count + kMostPoints - 1) / kMostPoints;
  buffers->points.clear();
  for (std::size_t i = 0; i < border.count; i += step) {
    const GridPoint& a = points[i];
    const GridPoint& b = points[(i + 1) % border.count];
    const Eigen::Vector3d local = plane_from_camera * ray_at(0.5 * (a.x + b.x), 0.5 * (a.y + b.y));
    constexpr double kLeastForward = 0.2;
    if (local.z() < kLeastForward) return false;
    buffers->points.push_back(local.hnormalized());
  }
  return true;
}

}  // namespace kestrel
