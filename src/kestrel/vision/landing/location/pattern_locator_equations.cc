// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/location/pattern_locator_equations.h"

#include <span>
#include <utility>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/vision/landing/alignment/column_products.h"

namespace kestrel {

PatternLocator::EdgeColumns::EdgeColumns(const PrintEdges& found, std::size_t stride) {
  for (std::size_t i = 0; i < found.count; i += stride, ++count) {
    const PrintEdge& edge = found.edges[i];
    const Eigen::Vector2d pixel = edge.pixel();
    x_m[count] = static_cast<float>(edge.place->point.x());
    y_m[count] = static_cast<float>(edge.place->point.y());
    across_x[count] = static_cast<float>(edge.across.x());
    across_y[count] = static_cast<float>(edge.across.y());
    x_px[count] = static_cast<float>(pixel.x());
    y_px[count] = static_cast<float>(pixel.y());
    bend[count] = static_cast<float>(edge.bend);
    stretch[count] = 2 * edge.place->part + edge.place->side;
    follows[count] = stride == 1 && edge.follows;
  }
}

PatternLocator::Lens PatternLocator::LensOf(const State& state) const {
  const auto zoom = static_cast<float>(std::exp(state.log_focal));
  return {Principal().cast<float>(), (Principal() + state.principal_px).cast<float>(), zoom,
          static_cast<float>(1 / std::pow(zoom * camera_.intrinsics().fx_px, 2))};
}

void PatternLocator::Project(const RigidTransform& pose, const EdgeColumns& edges,
                             Outlines* outlines) const {
  const std::size_t count = edges.count;
  const Eigen::Matrix<float, 3, 2> plane =
      pose.rotation.toRotationMatrix().leftCols<2>().cast<float>();
  const Eigen::Vector3f center = pose.translation.cast<float>();
  std::array<Column, 3> points;
  auto& from_center = outlines->from_center;
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < count; ++i) {
      from_center[k][i] = plane(k, 0) * edges.x_m[i] + plane(k, 1) * edges.y_m[i];
      points[k][i] = center(k) + from_center[k][i];
    }
  }
  auto& by_point = outlines->by_point;
  const std::array<float*, 6> derivatives{by_point[0].data(), by_point[1].data(),
                                          by_point[2].data(), by_point[3].data(),
                                          by_point[4].data(), by_point[5].data()};
  camera_.ProjectMany({points[0].data(), points[1].data(), points[2].data()}, count,
                      outlines->x_px.data(), outlines->y_px.data(), &derivatives);
}

void PatternLocator::Linearized::Compare(const Lens& lens, const Outlines& outlines,
                                         float spread_px, double scale_px) {
  const auto per_limit = static_cast<float>(1 / (4 * scale_px));
  Column& roots = columns[kSpread];
  for (std::size_t i = 0; i < edges.count; ++i) {
    const float x_px = outlines.x_px[i], y_px = outlines.y_px[i];
    const float x = lens.zoom * (x_px - lens.principal.x());
    const float y = lens.zoom * (y_px - lens.principal.y());
    const float offset = edges.across_x[i] * (edges.x_px[i] - lens.shown.x() - x) +
                         edges.across_y[i] * (edges.y_px[i] - lens.shown.y() - y) - spread_px;
    const float ratio = per_limit * offset;
    const float root = 1 - ratio * ratio;
    const float radial = edges.across_x[i] * x + edges.across_y[i] * y;
    columns[kFocal][i] = radial;
    columns[kDistortion][i] = radial * (x * x + y * y) * lens.per_focal_squared;
    offsets[i] = offset;
    shifts[i] = edges.across_x[i] * (lens.shown.x() + x - x_px) +
                edges.across_y[i] * (lens.shown.y() + y - y_px);
    roots[i] = root > 0 ? root : 0;
  }
  used = 0;
  for (std::size_t i = 0; i < edges.count; ++i) used += roots[i] > 0 ? 1 : 0;
}

void PatternLocator::Linearized::Differentiate(const Lens& lens, Outlines* outlines) {
  auto& by_point = outlines->by_point;
  for (std::size_t i = 0; i < edges.count; ++i) {
    if (!std::isnan(offsets[i])) continue;
    offsets[i] = kOutsideModelPx;
    shifts[i] = columns[kFocal][i] = columns[kDistortion][i] = 0;
    for (Column& column : by_point) column[i] = 0;
  }
  const Column& roots = columns[kSpread];
  const auto& from_center = outlines->from_center;
  for (std::size_t i = 0; i < edges.count; ++i) {
    const float across_x = roots[i] * edges.across_x[i], across_y = roots[i] * edges.across_y[i];
    const float dx = lens.zoom * (across_x * by_point[0][i] + across_y * by_point[3][i]);
    const float dy = lens.zoom * (across_x * by_point[1][i] + across_y * by_point[4][i]);
    const float dz = lens.zoom * (across_x * by_point[2][i] + across_y * by_point[5][i]);
    columns[kPoseTranslation][i] = dx;
    columns[kPoseTranslation + 1][i] = dy;
    columns[kPoseTranslation + 2][i] = dz;
    columns[kPoseRotation][i] = from_center[1][i] * dz - from_center[2][i] * dy;
    columns[kPoseRotation + 1][i] = from_center[2][i] * dx - from_center[0][i] * dz;
    columns[kPoseRotation + 2][i] = from_center[0][i] * dy - from_center[1][i] * dx;
    columns[kFocal][i] *= roots[i];
    columns[kDistortion][i] *= roots[i];
    columns[kPrincipal][i] = across_x;
    columns[kPrincipal + 1][i] = across_y;
    columns[kOffset][i] = roots[i] * offsets[i];
    columns[kBlur][i] = roots[i] * edges.bend[i];
  }
}

// Linearizes the edges about a state, at the scale 'scale_px', for its first 'unknowns'.
void PatternLocator::Linearize(const State& state, double scale_px, int unknowns,
                               Linearized* linearized) const {
  const Lens lens = LensOf(state);
  Outlines outlines;
  Project(state.pose, linearized->edges, &outlines);
  linearized->Compare(lens, outlines, static_cast<float>(state.spread_px), scale_px);
  linearized->Differentiate(lens, &outlines);
  linearized->Sum(unknowns);
}

void PatternLocator::Linearized::Sum(int unknowns) {
  std::array<int, kEdgeColumns> which;
  std::array<const float*, kEdgeColumns> pointers;
  int count = 0;
  for (int k = 0; k < kEdgeColumns; ++k) {
    const bool isrequested = k < unknowns || k == kSpread || k == kOffset;
    if (!isrequested && unknowns < kUnknowns) continue;
    which[count] = k;
    pointers[count++] = columns[k].data();
  }
  std::array<double, kEdgeColumns * kEdgeColumns> sums;
  SumProducts(std::span(pointers).first(count), edges.count, sums.data());
  Eigen::Matrix<double, kEdgeColumns, kEdgeColumns> products;
  products.setZero();
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b < count; ++b) products(which[a], which[b]) = sums[a * count + b];
  }
  equations.h = products.topLeftCorner<kUnknowns, kUnknowns>();
  equations.g = products.col(kOffset).head<kUnknowns>();
  by_blur = products.col(kBlur).head<kUnknowns>();
  weights = products(kSpread, kSpread);
}

double PatternLocator::Linearized::RobustScale() const {
  Column magnitudes;
  std::size_t found = 0;
  for (std::size_t i = 0; i < edges.count; ++i) {
    magnitudes[found] = std::abs(offsets[i]);
    found += magnitudes[found] < kOutsideModelPx ? 1 : 0;
  }
  return RobustSigmaInPlace(std::span(magnitudes).first(found));
}

double PatternLocator::Linearized::NextScale(double scale_px) const {
  const double scale = std::clamp(RobustScale(), EdgeFit::kLeastScalePx, scale_px);
  return scale_px == kFarScalePx ? std::max(scale, 1.0) : scale;
}

double PatternLocator::Linearized::Movement(const Vector& step) const {
  return std::sqrt(std::max(0.0, step.dot(equations.h * step)) / weights);
}

PatternLocator::Residuals::Residuals(const Linearized& linearized, const Vector& step, int unknowns)
    : used(static_cast<double>(linearized.used)), weights(linearized.weights) {
  const EdgeColumns& edges = linearized.edges;
  Column residuals = linearized.columns[kOffset];  // times the root of the weight
  for (int k = 0; k < unknowns; ++k) {
    const Column& column = linearized.columns[k];
    const auto along = static_cast<float>(step(k));
    for (std::size_t i = 0; i < edges.count; ++i) residuals[i] -= along * column[i];
  }
  double before = 0;
  bool has_edge_before = false;
  for (std::size_t i = 0; i < edges.count; ++i) {
    const double root = linearized.columns[kSpread][i];
    const bool has_weight = root > 0;
    const bool follows = std::exchange(has_edge_before, has_weight) && edges.follows[i];
    if (!has_weight) continue;
    const double weighted = residuals[i];
    weighted_squares += weighted * weighted;
    double by_camera = weighted + root * linearized.shifts[i];
    for (int k = kFocal; k < std::min(kDistortion, unknowns); ++k) {
      by_camera += step(k) * linearized.columns[k][i];
    }
    camera_squares += by_camera * by_camera;
    Stretch& stretch = outline[edges.stretch[i]];
    stretch.sum += root * weighted;
    stretch.weights += root * root;
    const double residual = weighted / root;
    if (follows) neighbors.Add(before, residual);
    before = residual;
  }
}

double PatternLocator::Residuals::EdgeVariance() const {
  constexpr double kMaxCorrelation = 0.9;  // largest correlation of neighbouring residuals
  constexpr double kStretchEdges = 3;
  const double freedom = std::max(1.0, used - kPoseUnknowns) / used;
  const double of_edges = MeanSquare() / freedom * neighbors.Redundancy(kMaxCorrelation);
  double squares = 0;
  int stretches = 0;
  for (const Stretch& stretch : outline) {
    if (stretch.weights < kStretchEdges) continue;
    squares += stretch.sum * stretch.sum / stretch.weights;
    ++stretches;
  }
  const double of_stretches_freedom = stretches - kPoseUnknowns;
  if (of_stretches_freedom < 1) return of_edges;
  // Ratio that such means exceed by chance in one of twenty prints (F distribution).
  constexpr double kByChance = 1.9;
  const double of_stretches = squares / of_stretches_freedom;
  return of_stretches > kByChance * of_edges ? of_stretches : of_edges;
}

}  // namespace kestrel
