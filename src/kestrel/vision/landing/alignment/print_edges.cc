// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/alignment/print_edges.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "kestrel/vision/landing/alignment/print_edge_kernel.h"
#include "kestrel/vision/landing/image_properties.h"

namespace kestrel {
namespace {

constexpr int kMaxReach = 12;  // px

// Returns the error (px) by which each edge of a stroke seems too far outside. The blurred other
// edge reduces the rise on the stroke's side, so the parabola through the three rises leans
// outwards.
double ComputeStrokeShift(double width_px) {
  // Interpolation and differences add blur.
  constexpr double kVariance = LensBlur::kGoodPx * LensBlur::kGoodPx + 1.0 / 6 + 1.0 / 12;
  const double away = width_px - 1;
  const double taken = std::exp(-away * away / (2 * kVariance));
  const double fall =
      1 - std::exp(-1 / (2 * kVariance));  // from the steepest rise to its neighbour
  return 0.5 * taken / (2 * fall + taken);
}

// ComputeStrokeShift from a table.
double StrokeShift(double width_px) {
  constexpr double kFar = 6;  // beyond this width the other edge has no effect
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

// Searches the edge of every stride-th place. Returns the number of places.
std::size_t LookFor(const cv::Mat& image, const ImageRegion& region, const PlaneWarp& warp,
                    std::span<const PrintOutline::Place> places, const EdgeSearch& search,
                    PlaceColumns* columns) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < places.size(); i += search.stride, ++count) {
    columns->x_m[count] = static_cast<float>(places[i].point.x());
    columns->y_m[count] = static_cast<float>(places[i].point.y());
    columns->normal_x[count] = static_cast<float>(places[i].normal.x());
    columns->normal_y[count] = static_cast<float>(places[i].normal.y());
  }
  auto& by_place = columns->by_place;
  const std::array<float*, 4> derivatives{by_place[0].data(), by_place[1].data(),
                                          by_place[2].data(), by_place[3].data()};
  warp.ProjectMany(columns->x_m.data(), columns->y_m.data(), count, columns->x_px.data(),
                   columns->y_px.data(), &derivatives);
  TurnNormals(count, columns);
  const Eigen::Vector2f first = region.FromFull(Eigen::Vector2d::Zero()).cast<float>();
  const int reach = std::clamp(static_cast<int>(std::ceil(search.reach_px)), 1, kMaxReach);
  SearchEdges(image,
              {first.x(), first.y(), static_cast<float>(1 / region.scale()), reach,
               static_cast<float>(search.min_step)},
              count, columns);
  return count;
}

}  // namespace

bool PrintEdges::IsPart() const {
  return 4 * in_image < 3 * std::accumulate(part_places.begin(), part_places.end(), 0);
}

void FindPrintEdges(const cv::Mat& image, const ImageRegion& region, const PlaneWarp& warp,
                    std::span<const PrintOutline::Place> places, const EdgeSearch& search,
                    PrintEdges* found) {
  found->count = 0;
  found->in_image = 0;
  found->part_places.fill(0);
  found->part_in_image.fill(0);
  PlaceColumns columns;
  const std::size_t count = LookFor(image, region, warp, places, search, &columns);
  const double scale = region.scale();
  const double blur_px = LensBlur::kGoodPx * scale;
  bool has_edge_before = false;  // the place before this one on its outline
  for (std::size_t i = 0; i < count; ++i) {
    const PrintOutline::Place& place = places[i * search.stride];
    const bool follows = std::exchange(has_edge_before, false) &&
                         PrintOutline::AreOnOneOutline(places[(i - 1) * search.stride], place);
    ++found->part_places[place.part];
    const double offset = columns.offset_px[i];
    if (std::isnan(offset)) continue;
    ++found->in_image;
    ++found->part_in_image[place.part];
    if (std::isinf(offset)) continue;
    // Blur moves a curved edge towards the middle of its bend.
    const double bend = place.curvature * columns.bend[i];
    const double width_px = place.width * columns.px_per_m[i];
    PrintEdge& edge = found->edges[found->count++];
    edge.place = &place;
    edge.expected_px = {columns.x_px[i], columns.y_px[i]};
    edge.across = {columns.across_x[i], columns.across_y[i]};
    edge.offset_px = scale * (offset - StrokeShift(width_px / scale)) + blur_px * blur_px * bend;
    edge.bend = bend;
    edge.follows = follows;
    has_edge_before = true;
  }
}

}  // namespace kestrel
