// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/print_edges.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>

namespace kestrel {
namespace {

constexpr int kMaxReach = 12;          // px
constexpr float kLeastEdgeStep = 2;    // of an edge, gray values per pixel
constexpr float kStepInShadow = 0.3f;  // the same against the gray value on its bright side
constexpr float kLeastShare = 0.12f;   // of the steepest rise, that its neighbours have

// Whether the image shows all that FindEdge looks at.
bool ShowsSearch(const cv::Mat& image, const Eigen::Vector2d& at, const Eigen::Vector2d& normal,
                 int reach) {
  const Eigen::Array2d span = (reach + 1.5) * normal.array().abs();
  constexpr double kRounding = 0.01;  // of the places along the way
  return (at.array() - span >= kRounding).all() &&
         (at.array() + span <= Eigen::Array2d(image.cols - 1, image.rows - 1) - kRounding).all();
}

// Gray values at places one 'step' apart, bilinear, all of which the image must show. In fixed
// point, as the places follow each other: these are most of what the location of a pattern costs.
void SampleLine(const cv::Mat& image, const Eigen::Vector2d& first, const Eigen::Vector2d& step,
                int count, float* gray) {
  constexpr int kPlaceBits = 16, kFractionBits = 10;
  constexpr int kFraction = (1 << kFractionBits) - 1;
  const auto fixed = [](double value) { return static_cast<int>(value * (1 << kPlaceBits)); };
  const std::size_t stride = image.step[0];
  int x = fixed(first.x()), y = fixed(first.y());
  const int step_x = fixed(step.x()), step_y = fixed(step.y());
  for (int i = 0; i < count; ++i, x += step_x, y += step_y) {
    const std::uint8_t* upper = image.data + stride * (y >> kPlaceBits) + (x >> kPlaceBits);
    const std::uint8_t* lower = upper + stride;
    const int fx = (x >> (kPlaceBits - kFractionBits)) & kFraction;
    const int fy = (y >> (kPlaceBits - kFractionBits)) & kFraction;
    const int top = (upper[0] << kFractionBits) + fx * (upper[1] - upper[0]);
    const int bottom = (lower[0] << kFractionBits) + fx * (lower[1] - lower[0]);
    const int value = (top << kFractionBits) + fy * (bottom - top);
    gray[i] = static_cast<float>(value) * (1.0f / (1 << 2 * kFractionBits));
  }
}

// Binary logarithm of a positive normal number, to 0.01: exponent, and mantissa by a parabola.
float Log2(float value) {
  constexpr int kMantissaBits = 23;
  constexpr std::uint32_t kMantissa = (1u << kMantissaBits) - 1;
  constexpr int kBias = 127;
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const float t = static_cast<float>(bits & kMantissa) * (1.0f / (1u << kMantissaBits));
  return static_cast<float>(static_cast<int>(bits >> kMantissaBits) - kBias) +
         t * (1.3465f - 0.3465f * t);
}

// Offset (px) along the unit vector 'normal' from 'at' to the steepest rise of brightness within
// 'reach' pixels, all of which the image must show; nothing when there is none.
std::optional<double> FindEdge(const cv::Mat& image, const Eigen::Vector2d& at,
                               const Eigen::Vector2d& normal, int reach, float min_step) {
  std::array<float, 2 * kMaxReach + 4> gray;
  const int count = 2 * reach + 4;
  SampleLine(image, at - (reach + 1.5) * normal, normal, count, gray.data());
  // Rise between neighbours; the one at index i lies at offset i - reach - 1.
  int best = -1;
  float best_rise = kLeastEdgeStep;
  for (int i = 1; i + 2 < count; ++i) {
    const float rise = gray[i + 1] - gray[i];
    if (rise > best_rise) {
      best_rise = rise;
      best = i;
    }
  }
  // In a shadow the print's contrast is lower, and so is its white.
  if (best < 0 || best_rise < std::min(min_step, kStepInShadow * gray[best + 1])) {
    return std::nullopt;
  }
  // The rise across a blurred edge is a Gaussian, its logarithm a parabola: a parabola through the
  // rises themselves would stay short of the edge by a third.
  const float least = kLeastShare * best_rise;
  const float before = Log2(std::max(gray[best] - gray[best - 1], least));
  const float here = Log2(best_rise);
  const float after = Log2(std::max(gray[best + 2] - gray[best + 1], least));
  const float curvature = before - 2 * here + after;
  const float shift =
      curvature < 0 ? std::clamp(0.5f * (before - after) / curvature, -0.5f, 0.5f) : 0;
  return best - reach - 1 + static_cast<double>(shift);
}

// By how far (px) the two edges of a stroke seem too far apart, each: the blurred other edge takes
// from the rise on the stroke's side, and the parabola through the three leans the other way.
double ComputeStrokeShift(double width_px) {
  // Interpolation and differences blur once more.
  constexpr double kVariance = kLensBlurPx * kLensBlurPx + 1.0 / 6 + 1.0 / 12;
  const double away = width_px - 1;
  const double taken = std::exp(-away * away / (2 * kVariance));
  const double fall =
      1 - std::exp(-1 / (2 * kVariance));  // from the steepest rise to its neighbour
  return 0.5 * taken / (2 * fall + taken);
}

// The same from a table.
double StrokeShift(double width_px) {
  constexpr double kFar = 6;  // from where the other edge does not reach here
  constexpr int kPerPixel = 32;
  static const auto kTable = [] {
    std::array<double, static_cast<std::size_t>(kFar) * kPerPixel + 1> table;
    for (std::size_t i = 0; i < table.size(); ++i) {
      table[i] = ComputeStrokeShift(static_cast<double>(i) / kPerPixel);
    }
    return table;
  }();
  if (!(width_px < kFar)) return 0;
  return kTable[static_cast<std::size_t>(std::max(width_px, 0.0) * kPerPixel)];
}

}  // namespace

bool PrintEdges::IsPart() const {
  return 4 * in_image < 3 * std::accumulate(part_places.begin(), part_places.end(), 0);
}

double PrintEdges::RobustScale() const {
  std::array<float, PrintOutline::kMaxPlaces> magnitudes{};
  for (std::size_t i = 0; i < count; ++i) {
    magnitudes[i] = static_cast<float>(std::abs(ResidualOf(edges[i])));
  }
  const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(magnitudes.begin(), middle,
                   magnitudes.begin() + static_cast<std::ptrdiff_t>(count));
  return 1.4826 * static_cast<double>(*middle);
}

void FindPrintEdges(const cv::Mat& image, const ImageRegion& region, const PlaneWarp& warp,
                    std::span<const PrintOutline::Place> places, const EdgeSearch& search,
                    PrintEdges* found) {
  found->count = 0;
  found->in_image = 0;
  found->part_places.fill(0);
  found->part_in_image.fill(0);
  const int reach = std::clamp(static_cast<int>(std::ceil(search.reach_px)), 1, kMaxReach);
  bool has_edge_before = false;  // the place before this one on its outline
  for (std::size_t i = 0; i < places.size(); i += search.stride) {
    const PrintOutline::Place& place = places[i];
    const bool follows = std::exchange(has_edge_before, false) && i >= search.stride &&
                         PrintOutline::AreOnOneOutline(places[i - search.stride], place);
    ++found->part_places[place.part];
    Eigen::Vector2d pixel;
    Eigen::Matrix2d d_plane;
    if (!warp.Project(place.point, &pixel, &d_plane)) continue;
    // Normal of the outline in the image: at right angles to the image of its tangent.
    const Eigen::Vector2d tangent = d_plane * Eigen::Vector2d(-place.normal.y(), place.normal.x());
    Eigen::Vector2d across(-tangent.y(), tangent.x());
    if (across.dot(d_plane * place.normal) < 0) across = -across;
    across.normalize();
    const Eigen::Vector2d in_region = region.FromFull(pixel);
    if (!ShowsSearch(image, in_region, across, reach)) continue;
    ++found->in_image;
    ++found->part_in_image[place.part];
    const std::optional<double> offset =
        FindEdge(image, in_region, across, reach, static_cast<float>(search.min_step));
    if (!offset) continue;
    // Blur moves a bent edge towards the middle of the bend.
    const double bend = 0.5 * place.curvature * std::abs(d_plane.determinant()) /
                        (tangent.squaredNorm() * tangent.norm());
    const double width_px = place.width * across.dot(d_plane * place.normal);
    const double blur_px = kLensBlurPx * region.scale();
    PrintEdge& edge = found->edges[found->count++];
    edge.place = &place;
    edge.expected_px = pixel;
    edge.across = across;
    edge.offset_px = region.scale() * (*offset - StrokeShift(width_px / region.scale())) +
                     blur_px * blur_px * bend;
    edge.bend = bend;
    edge.follows = follows;
    has_edge_before = true;
  }
}

}  // namespace kestrel
