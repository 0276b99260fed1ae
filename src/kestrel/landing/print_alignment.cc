// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/print_alignment.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace kestrel {
namespace {

constexpr int kTerms = PlaneWarp::kTerms;
constexpr std::size_t kMinEdges = 12;
// Standard deviations of the displacement before the image is looked at, by degree: shares of the
// ring's mean radius in the image.
constexpr std::array<double, PlaneWarp::kDegree + 1> kPriorShare{0.5, 0.3, 0.12, 0.06};
constexpr double kLeastScalePx = 0.25;
constexpr double kInPlacePx = 1;  // offset of an edge that is the outline's own
constexpr double kLeastReachPx = 1.5;
constexpr double kFarReachPx = 6;  // at least, pixels of the view
constexpr double kLeastRmsPx = 0.05;
constexpr double kSpreadSigmaPx = 0.3;  // before the image is looked at
constexpr int kFarSteps = 2;            // on the view
constexpr int kNearSteps = 3;           // on the image
// Places per place that all steps but the last look at: odd, so that both sides of the arms have
// some; and too few edges of those.
constexpr std::size_t kCoarseStride = 3;
constexpr std::size_t kFewEdges = 36;

double Squared(double value) { return value * value; }

constexpr int kUnknowns = 2 * kTerms + 1;  // the displacement along both axes, and the spread
using Block = Eigen::Matrix<double, kTerms, kTerms>;
using Terms = PlaneWarp::Terms;

// Normal equations of a step.
struct Equations {
  Block xx = Block::Zero(), xy = Block::Zero(), yy = Block::Zero();
  Terms x_spread = Terms::Zero(), y_spread = Terms::Zero(), x = Terms::Zero(), y = Terms::Zero();
  double weights = 0, spread = 0;

  void Add(const Terms& terms, const Eigen::Vector2d& across, double offset, double weight) {
    const Terms weighted = weight * terms;
    const double cos = across.x(), sin = across.y();
    for (int c = 0; c < kTerms; ++c) {
      const Terms column = terms(c) * weighted;
      xx.col(c) += cos * cos * column;
      xy.col(c) += cos * sin * column;
      yy.col(c) += sin * sin * column;
    }
    x_spread += cos * weighted;
    y_spread += sin * weighted;
    x += offset * cos * weighted;
    y += offset * sin * weighted;
    weights += weight;
    spread += offset * weight;
  }

  // Adds that the displacement should be small, by its degrees, and the spread too.
  void AddPrior(const PrintAlignment& alignment, double scale_px, double ring_radius_px) {
    const PlaneWarp::Coefficients& displacement = alignment.warp.displacement();
    for (int i = 0; i < kTerms; ++i) {
      const double sigma = kPriorShare[PlaneWarp::DegreeOf(i)] * ring_radius_px;
      const double weight = Squared(scale_px / sigma);
      xx(i, i) += weight;
      yy(i, i) += weight;
      x(i) -= weight * displacement(0, i);
      y(i) -= weight * displacement(1, i);
    }
    const double weight = Squared(scale_px / kSpreadSigmaPx);
    weights += weight;
    spread -= weight * alignment.edges.spread_px;
  }
};

// Makes one step and leaves of the offsets what it does not explain.
void Step(double scale_px, double ring_radius_px, PrintAlignment* alignment) {
  PrintEdges& found = alignment->edges;
  std::array<Terms, PrintOutline::kMaxPlaces> terms;
  std::array<double, PrintOutline::kMaxPlaces> weights;
  Equations equations;
  const auto weight_of = [scale_px](double offset) {
    const double ratio = offset / (4 * scale_px);
    return std::abs(ratio) >= 1 ? 0 : Squared(1 - ratio * ratio);
  };
  for (std::size_t i = 0; i < found.count; ++i) {
    const PrintEdge& edge = found.edges[i];
    const double residual = found.ResidualOf(edge);
    terms[i] = alignment->warp.TermsAt(edge.place->point);
    weights[i] = weight_of(residual);
    equations.Add(terms[i], edge.across, residual, weights[i]);
  }
  equations.AddPrior(*alignment, scale_px, ring_radius_px);
  Eigen::Matrix<double, kUnknowns, kUnknowns> h;
  Eigen::Matrix<double, kUnknowns, 1> g;
  h << equations.xx, equations.xy, equations.x_spread,  //
      equations.xy, equations.yy, equations.y_spread,   //
      equations.x_spread.transpose(), equations.y_spread.transpose(), equations.weights;
  g << equations.x, equations.y, equations.spread;
  const Eigen::LDLT<decltype(h)> decomposition(h);
  const decltype(g) solution = decomposition.solve(g);
  PlaneWarp::Coefficients step;
  step << solution.head<kTerms>().transpose(), solution.segment<kTerms>(kTerms).transpose();
  alignment->warp.Displace(step);
  found.spread_px += solution(kUnknowns - 1);

  double squares = 0, sum = 0;
  for (std::size_t i = 0; i < found.count; ++i) {
    PrintEdge& edge = found.edges[i];
    const double along = edge.across.dot(step * terms[i]);
    edge.expected_px += along * edge.across;
    edge.offset_px -= along;
    squares += weights[i] * Squared(found.ResidualOf(edge));
    sum += weights[i];
  }
  alignment->edge_rms_px = std::sqrt(squares / std::max(sum, 1e-9));
  const auto variance = [&](int i) { return decomposition.solve(decltype(g)::Unit(i).eval())(i); };
  alignment->center_sigma_px = std::max(alignment->edge_rms_px, kLeastRmsPx) *
                               std::sqrt(0.5 * (variance(0) + variance(kTerms)));
}

}  // namespace

PartShares PrintAlignment::EdgeShares() const {
  std::array<int, PrintOutline::kParts> in_place{};
  for (const PrintEdge& edge : edges.all()) {
    in_place[edge.place->part] += std::abs(edges.ResidualOf(edge)) <= kInPlacePx;
  }
  PartShares shares;
  for (int part = 0; part < PrintOutline::kParts; ++part) {
    const int seen = edges.part_in_image[part];
    const double share = 4 * seen < edges.part_places[part] || seen == 0
                             ? -1.0
                             : static_cast<double>(in_place[part]) / seen;
    (part < PrintOutline::kArms ? shares.arm : shares.ring)[part % PrintOutline::kArms] = share;
  }
  return shares;
}

bool AlignPrint(const cv::Mat& image, const cv::Mat& view, const ImageRegion& region,
                std::span<const PrintOutline::Place> places, double reach_px, double min_step,
                PrintAlignment* alignment) {
  Eigen::Vector2d center;
  Eigen::Matrix2d d_plane;
  if (!alignment->warp.Project(Eigen::Vector2d::Zero(), &center, &d_plane)) return false;
  const double ring_radius_px =
      places.front().point.norm() * std::sqrt(std::abs(d_plane.determinant()));
  double scale = std::max(1.0, 0.5 * reach_px);
  double reach = reach_px;
  for (int i = 0; i < kFarSteps + kNearSteps; ++i) {
    const bool far = i < kFarSteps;
    const bool last = i + 1 == kFarSteps + kNearSteps;
    // What is far off is looked for where a pixel is large.
    const ImageRegion& seen = far ? region : ImageRegion{};
    EdgeSearch search{reach / seen.scale(), min_step, last ? 1 : kCoarseStride};
    if (far) search.reach_px = std::max(kFarReachPx, search.reach_px);
    FindPrintEdges(far ? view : image, seen, alignment->warp, places, search, &alignment->edges);
    if (!last && alignment->edges.count < kFewEdges) {
      search.stride = 1;
      FindPrintEdges(far ? view : image, seen, alignment->warp, places, search, &alignment->edges);
    }
    if (alignment->edges.count < kMinEdges) return false;
    Step(scale, ring_radius_px, alignment);
    scale = std::clamp(alignment->edges.RobustScale(), kLeastScalePx * seen.scale(), scale);
    reach = std::clamp(4 * scale, kLeastReachPx, reach);
  }
  return true;
}

}  // namespace kestrel
