// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/alignment/print_alignment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kestrel/vision/landing/alignment/column_products.h"
#include "kestrel/vision/landing/alignment/positive_solver.h"
#include "kestrel/vision/landing/alignment/robust_scale.h"

namespace kestrel {
namespace {

constexpr int kTerms = PlaneWarp::kTerms;
// Prior standard deviations of the displacement by degree, as shares of the ring's mean radius in
// the image.
constexpr std::array<double, PlaneWarp::kDegree + 1> kPriorShare{0.5, 0.3, 0.12, 0.06};
constexpr double kInPlacePx = 1;  // largest offset of an edge in its place
constexpr double kLeastReachPx = 1.5;
constexpr double kFarReachPx = 6;  // least reach of the first steps, pixels of the view
constexpr double kLeastRmsPx = 0.05;
constexpr double kSpreadSigmaPx = 0.3;  // prior standard deviation of the spread
constexpr int kFarSteps = 2;            // most steps on the view
constexpr int kNearSteps = 3;           // most steps on the image
constexpr double kSettledPx = 0.1;      // outlines that move by less have settled

double Squared(double value) { return value * value; }

constexpr int kUnknowns = 2 * kTerms + 1;  // the displacement along both axes, and the spread
constexpr int kSpread = 2 * kTerms;
using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Vector = Eigen::Matrix<double, kUnknowns, 1>;
using Products = Eigen::Matrix<double, kUnknowns + 1, kUnknowns + 1>;

// The edges by columns. Offsets are weighted by Tukey's function.
class Columns {
 public:
  Columns(const PrintAlignment& alignment, double scale_px) : count_(alignment.edges.count) {
    const double per_m = 1 / alignment.warp.radius_m();
    for (std::size_t i = 0; i < count_; ++i) {
      const PrintEdge& edge = alignment.edges.edges[i];
      x_[i] = static_cast<float>(per_m * edge.place->point.x());
      y_[i] = static_cast<float>(per_m * edge.place->point.y());
      cos_[i] = static_cast<float>(edge.across.x());
      sin_[i] = static_cast<float>(edge.across.y());
      offset_[i] = static_cast<float>(alignment.edges.ResidualOf(edge));
    }
    const auto per_limit = static_cast<float>(1 / (4 * scale_px));
    for (std::size_t i = 0; i < count_; ++i) {
      const float ratio = per_limit * offset_[i];
      root_[i] = std::max(0.0f, 1 - ratio * ratio);
    }
  }

  // Sums of the products of derivatives and offset, weighted.
  Products Sum() const {
    std::array<Column, kUnknowns + 1> weighted;
    for (std::size_t i = 0; i < count_; ++i) {
      const float x = x_[i], y = y_[i], square = x * x + y * y;
      const std::array<float, kTerms> terms{1, x, y, x * x, x * y, y * y, square * x, square * y};
      const float cos = root_[i] * cos_[i], sin = root_[i] * sin_[i];
      for (int k = 0; k < kTerms; ++k) {
        weighted[k][i] = cos * terms[k];
        weighted[kTerms + k][i] = sin * terms[k];
      }
      weighted[kSpread][i] = root_[i];
      weighted[kUnknowns][i] = root_[i] * offset_[i];
    }
    std::array<const float*, kUnknowns + 1> pointers;
    for (int k = 0; k <= kUnknowns; ++k) pointers[k] = weighted[k].data();
    Products products;
    SumProducts(pointers, count_, products.data());
    return products;
  }

  // Moves the edges by a displacement of the outlines and a spread.
  void Move(const PlaneWarp::Coefficients& displacement, double spread_px, PrintEdges* edges) {
    const auto by_x = PlaneWarp::AxisOf(displacement, 0), by_y = PlaneWarp::AxisOf(displacement, 1);
    const auto spread = static_cast<float>(spread_px);
    Column along;
    for (std::size_t i = 0; i < count_; ++i) {
      along[i] = cos_[i] * PlaneWarp::Displacement(by_x, x_[i], y_[i]) +
                 sin_[i] * PlaneWarp::Displacement(by_y, x_[i], y_[i]);
      offset_[i] -= along[i] + spread;
    }
    for (std::size_t i = 0; i < count_; ++i) {
      PrintEdge& edge = edges->edges[i];
      edge.expected_px += along[i] * edge.across;
      edge.offset_px -= along[i];
    }
    edges->spread_px += spread_px;
  }

  // Weighted root mean square of the offsets, and their standard deviation from the median.
  double Rms() const {
    double squares = 0, sum = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      squares += Squared(root_[i] * offset_[i]);
      sum += Squared(root_[i]);
    }
    return std::sqrt(squares / std::max(sum, std::numeric_limits<double>::min()));
  }
  double RobustScale() const { return kestrel::RobustScale(std::span(offset_).first(count_)); }

 private:
  using Column = std::array<float, PrintOutline::kMaxPlaces>;

  std::size_t count_;
  Column x_, y_;      // coordinates of the place, in radii
  Column cos_, sin_;  // normal of the outline in the image
  Column offset_;     // px
  Column root_;       // root of the weight
};

// Result of a least-squares step.
struct Step {
  double moved_px;  // motion of the outlines, root mean square
  double scale_px;  // standard deviation of the remaining offsets
};

// Makes a step. The offsets become the residuals.
Step MakeStep(double scale_px, double ring_radius_px, PrintAlignment* alignment) {
  Columns columns(*alignment, scale_px);
  const Products products = columns.Sum();
  Matrix h = products.topLeftCorner<kUnknowns, kUnknowns>();
  // Right sides: the step, and a unit push of the print's middle along each axis, for its variance.
  constexpr int kSides = 3;
  Eigen::Matrix<double, kUnknowns, kSides> sides;
  sides << products.topRightCorner<kUnknowns, 1>(), Vector::Unit(0), Vector::Unit(kTerms);
  const double weights = h(kSpread, kSpread);
  // Priors: small displacements, by degree, and a small spread.
  const auto pull = [&](int unknown, double value, double sigma) {
    const double weight = Squared(scale_px / sigma);
    h(unknown, unknown) += weight;
    sides(unknown, 0) -= weight * value;
  };
  const PlaneWarp::Coefficients& before = alignment->warp.displacement();
  for (int i = 0; i < kTerms; ++i) {
    const double sigma = kPriorShare[PlaneWarp::DegreeOf(i)] * ring_radius_px;
    pull(i, before(0, i), sigma);
    pull(kTerms + i, before(1, i), sigma);
  }
  pull(kSpread, alignment->edges.spread_px, kSpreadSigmaPx);
  const auto solutions = SolvePositive<kUnknowns, kSides>(h, sides);
  const Vector step = solutions.col(0);
  PlaneWarp::Coefficients displacement;
  displacement << step.head<kTerms>().transpose(), step.segment<kTerms>(kTerms).transpose();
  alignment->warp.Displace(displacement);
  columns.Move(displacement, step(kSpread), &alignment->edges);
  alignment->edge_rms_px = columns.Rms();
  alignment->center_sigma_px = std::max(alignment->edge_rms_px, kLeastRmsPx) *
                               std::sqrt(0.5 * (solutions(0, 1) + solutions(kTerms, 2)));
  const double moved =
      std::max(0.0, step.dot(sides.col(0))) / std::max(weights, std::numeric_limits<double>::min());
  return {std::sqrt(moved), columns.RobustScale()};
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
  bool settled = false;
  const auto make_step = [&](const ImageRegion& seen, bool is_last) {
    // Large offsets are searched for at low resolution, where a pixel is large.
    const bool far = &seen == &region;
    EdgeSearch search{reach / seen.scale(), min_step, is_last ? 1 : EdgeFit::kCoarseStride};
    if (far) search.reach_px = std::max(kFarReachPx, search.reach_px);
    const auto look = [&] {
      FindPrintEdges(far ? view : image, seen, alignment->warp, places, search, &alignment->edges);
    };
    look();
    if (!is_last && alignment->edges.count < EdgeFit::kFewEdges) {
      search.stride = 1;
      look();
    }
    if (alignment->edges.count < EdgeFit::kLeastEdges) return false;
    const Step step = MakeStep(scale, ring_radius_px, alignment);
    scale = std::clamp(step.scale_px, EdgeFit::kLeastScalePx * seen.scale(), scale);
    reach = std::clamp(4 * scale, kLeastReachPx, reach);
    settled = step.moved_px < kSettledPx * seen.scale();
    return true;
  };
  const auto make_steps = [&](const ImageRegion& seen, int most) {
    bool is_aligned = true;
    settled = false;
    for (int i = 0; i < most && is_aligned && !settled; ++i) is_aligned = make_step(seen, false);
    return is_aligned;
  };
  return make_steps(region, kFarSteps) && make_steps({}, kNearSteps - 1) && make_step({}, true);
}

}  // namespace kestrel
