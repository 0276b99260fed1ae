// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/pattern_locator.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "kestrel/landing/neighbor_correlation.h"

namespace kestrel {
namespace {

constexpr int kMaxReach = 12;  // px
// Places per place that the first iterations look at: odd, so that both sides of the arms have
// some.
constexpr std::size_t kCoarseStride = 3;
constexpr std::size_t kFewEdges = 30;      // too few of those for a pose
constexpr std::size_t kMinEdges = 12;      // too few for anything
constexpr double kWholeRing = 0.75;        // share of its places that have an edge
constexpr float kLeastStep = 2;            // of an edge, gray values per pixel
constexpr float kStepInShadow = 0.3f;      // the same against the gray value on its bright side
constexpr float kLeastShare = 0.12f;       // of the steepest rise, that its neighbours have
constexpr double kOnEdgePx = 1.0;          // offset of an edge that is the outline's own
constexpr double kLensBlurPx = 0.7;        // of optics and pixels, standard deviation
constexpr double kBlurSpreadPx2 = 0.3;     // of its square, over lenses: 0.45 to 0.9 px
constexpr double kMaxRingScatterPx = 1.5;  // standard deviation, after two iterations
constexpr double kGathering = 0.6;         // of edges that gather still, from step to step
constexpr int kMoreIterations = 5;         // for a pose that still moves
constexpr double kMaxCorrelation = 0.9;    // of neighbouring residuals
constexpr double kSettledPx = 0.08;        // outlines that move by less stay where they are
constexpr double kRingSettledPx = 0.2;     // the same of a ring that is to be located yet
// Bright white spreads over the black where the image is overexposed, and ink runs: least spread
// that is believed, and the same in its standard deviations. Less is as likely noise, or what
// narrow strokes do to each other's edges.
constexpr double kLeastSpreadPx = 0.12;
constexpr double kSureSpread = 2;
constexpr double kHeld = 1e6;  // weight, in edges, of what is not to move

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
  float best_rise = kLeastStep;
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

// Where the edges are in the image.
struct PatternLocator::State {
  RigidTransform pose;
  double spread_px = 0;  // of the black over the white: how far each edge is off its outline

  // Changes the pose by a translation and a rotation vector about its origin, and the spread; false
  // when that is no small change.
  bool Move(const Vector& step) {
    const Eigen::Vector3d turn = step.segment<3>(3);
    if (!step.allFinite() || turn.norm() > 1) return false;
    pose = Moved(pose, step.head<3>(), turn);
    spread_px += step(kSpread);
    return true;
  }
};

// Normal equations of the state, and the edges that made them.
struct PatternLocator::Normal {
  static constexpr std::size_t kMaxEdges = 256;
  struct Edge {
    const Place* place;
    PoseVector jacobian;  // of the offset, by the pose; by the spread it is 1
    double offset;        // px, from where the state has it
    double weight;
    bool follows;  // the edge before is its neighbour on the outline
  };

  Matrix h;
  Vector g;
  Vector by_blur;  // derivative of g
  double weights = 0;
  int in_image = 0;
  std::array<int, 8> part_places{};  // by part: all, in the image
  std::array<int, 8> part_in_image{};
  std::array<Edge, kMaxEdges> edges;  // that have a weight
  std::size_t used = 0;
  std::array<float, kMaxEdges> magnitudes;  // of all offsets that were found
  std::size_t found = 0;

  // Standard deviation of the offsets by the median of their magnitudes.
  double RobustScale() {
    const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(found / 2);
    std::nth_element(magnitudes.begin(), middle,
                     magnitudes.begin() + static_cast<std::ptrdiff_t>(found));
    return 1.4826 * static_cast<double>(*middle);
  }

  // Whether a quarter of the places that were looked at is out of view.
  bool IsPart() const {
    const int places = std::accumulate(part_places.begin(), part_places.end(), 0);
    return 4 * in_image < 3 * places;
  }

  // By how much (px, root mean square) 'step' moves the outlines in the image.
  double Movement(const Vector& step) const {
    return std::sqrt(std::max(0.0, step.dot(h * step)) / weights);
  }
};

// What the edges are off the state once it has moved by a step.
struct PatternLocator::Residuals {
  Residuals(const Normal& normal, const Vector& step)
      : used(static_cast<double>(normal.used)), weights(normal.weights) {
    const PoseVector pose_step = step.head<kPoseUnknowns>();
    double before = 0;
    for (const Normal::Edge& edge : std::span(normal.edges).first(normal.used)) {
      const double residual = edge.offset - edge.jacobian.dot(pose_step) - step(kSpread);
      weighted_squares += edge.weight * residual * residual;
      part_used[edge.place->part] += std::abs(residual) <= kOnEdgePx;
      Stretch& stretch = outline[2 * edge.place->part + edge.place->side];
      stretch.sum += edge.weight * residual;
      stretch.weights += edge.weight;
      if (edge.follows) neighbors.Add(before, residual);
      before = residual;
    }
  }

  double MeanSquare() const { return weighted_squares / weights; }

  // Variance of an edge as the pose sees it: what neighbours have in common does not average out,
  // and what whole stretches of an outline have in common shows in how their means differ.
  double EdgeVariance() const {
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
    // By so much such means differ by chance in one of twenty prints (F distribution).
    constexpr double kByChance = 1.9;
    const double of_stretches = squares / of_stretches_freedom;
    return of_stretches > kByChance * of_edges ? of_stretches : of_edges;
  }

  struct Stretch {
    double sum = 0;  // of weighted residuals
    double weights = 0;
  };
  double used;
  double weights;
  double weighted_squares = 0;
  NeighborCorrelation neighbors;
  std::array<Stretch, 16> outline{};  // by part and side
  std::array<int, 8> part_used{};
};

PatternLocator::PatternLocator(const CameraModel& camera, const LandingPattern& pattern)
    : camera_(camera), pattern_(pattern) {
  AddCircle(pattern.outer_radius_m(), 1, 56, 0);
  AddCircle(pattern.inner_radius_m(), -1, 40, 0.8 * pattern.arm_width_m);
  ring_places_ = places_.size();
  AddArms();
}

// 'sign': 1 when the white lies outside. Points nearer than 'arm_clearance' to the axis of an arm
// are left out: there the outline may be broken.
void PatternLocator::AddCircle(double radius, double sign, int count, double arm_clearance) {
  for (int i = 0; i < count; ++i) {
    const double angle = (i + 0.5) * 2 * std::numbers::pi / count;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d point = radius * direction;
    if (std::min(std::abs(point.x()), std::abs(point.y())) < arm_clearance) continue;
    const int quarter = static_cast<int>(std::floor(angle / (std::numbers::pi / 2) + 0.5)) % 4;
    places_.push_back({point, sign * direction, 4 + quarter, sign > 0 ? 1 : 0,
                       pattern_.ring_width_m, sign / radius});
  }
}

void PatternLocator::AddArms() {
  const double half_width = 0.5 * pattern_.arm_width_m;
  const double first = 1.6 * pattern_.arm_width_m;
  const double last =
      std::min(pattern_.arm_half_length_m, pattern_.inner_radius_m()) - 0.8 * pattern_.arm_width_m;
  constexpr int kPerSide = 6;
  for (int arm = 0; arm < 4; ++arm) {
    const double angle = arm * std::numbers::pi / 2;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d across(-along.y(), along.x());
    for (const double side : {1.0, -1.0}) {
      for (int i = 0; i < kPerSide; ++i) {
        const double reach = first + (last - first) * i / (kPerSide - 1);
        places_.push_back({reach * along + side * half_width * across, side * across, arm,
                           side > 0 ? 1 : 0, pattern_.arm_width_m, 0});
      }
    }
  }
}

// Whether two places follow each other on a circle or on a side of an arm.
bool PatternLocator::AreOnOneOutline(const Place& a, const Place& b) {
  return a.curvature == b.curvature && a.side == b.side && (a.curvature != 0 || a.part == b.part);
}

// What each 'stride'-th place says of the state, weighted by Tukey's function of its offset with
// the given scale.
PatternLocator::Normal PatternLocator::Accumulate(const cv::Mat& image, const State& state,
                                                  std::span<const Place> places, std::size_t stride,
                                                  double reach_px, double min_step,
                                                  double scale_px) const {
  Normal normal;
  const RigidTransform& pose = state.pose;
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  const Eigen::Matrix<double, 3, 2> plane = rotation.leftCols<2>();
  const int reach = std::clamp(static_cast<int>(std::ceil(reach_px)), 1, kMaxReach);
  Eigen::Matrix<double, 2, 3> d_pixel;
  Eigen::Matrix<double, kPoseUnknowns, kPoseUnknowns> h = decltype(h)::Zero();
  PoseVector sum = PoseVector::Zero(), g = sum, by_blur = sum;
  double sum_offsets = 0, sum_bends = 0;
  bool has_edge_before = false;  // the place before this one on its outline
  for (std::size_t i = 0; i < places.size(); i += stride) {
    const Place& place = places[i];
    const bool follows = std::exchange(has_edge_before, false) && i >= stride &&
                         AreOnOneOutline(places[i - stride], place);
    ++normal.part_places[place.part];
    const Eigen::Vector3d from_center = plane * place.point;
    Eigen::Vector2d pixel;
    if (camera_.Project(from_center + pose.translation, &pixel, &d_pixel) !=
        ProjectionStatus::kOk) {
      continue;
    }
    const Eigen::Matrix2d d_plane = d_pixel * plane;
    // Normal of the outline in the image: at right angles to the image of its tangent.
    const Eigen::Vector2d tangent = d_plane * Eigen::Vector2d(-place.normal.y(), place.normal.x());
    Eigen::Vector2d across(-tangent.y(), tangent.x());
    if (across.dot(d_plane * place.normal) < 0) across = -across;
    across.normalize();
    if (!ShowsSearch(image, pixel, across, reach)) continue;
    ++normal.in_image;
    ++normal.part_in_image[place.part];
    std::optional<double> offset =
        FindEdge(image, pixel, across, reach, static_cast<float>(min_step));
    if (!offset) continue;
    // Blur moves a bent edge towards the middle of the bend.
    const double bend = 0.5 * place.curvature * std::abs(d_plane.determinant()) /
                        (tangent.squaredNorm() * tangent.norm());
    const double width_px = place.width * across.dot(d_plane * place.normal);
    *offset += kLensBlurPx * kLensBlurPx * bend - StrokeShift(width_px) - state.spread_px;
    normal.magnitudes[normal.found++] = static_cast<float>(std::abs(*offset));
    const double ratio = *offset / (4 * scale_px);
    if (std::abs(ratio) >= 1) continue;
    const double weight = (1 - ratio * ratio) * (1 - ratio * ratio);
    Normal::Edge& edge = normal.edges[normal.used++];
    const Eigen::Vector3d d_point = d_pixel.transpose() * across;
    edge.place = &place;
    edge.jacobian.head<3>() = d_point;
    edge.jacobian.tail<3>() = from_center.cross(d_point);
    edge.offset = *offset;
    edge.weight = weight;
    edge.follows = follows;
    const PoseVector weighted = weight * edge.jacobian;
    for (int c = 0; c < kPoseUnknowns; ++c) h.col(c) += edge.jacobian(c) * weighted;
    sum += weighted;
    g += *offset * weighted;
    by_blur += bend * weighted;
    sum_offsets += weight * *offset;
    sum_bends += weight * bend;
    normal.weights += weight;
    has_edge_before = true;
  }
  normal.h << h, sum, sum.transpose(), normal.weights;
  normal.g << g, sum_offsets;
  normal.by_blur << by_blur, sum_bends;
  return normal;
}

// Normal equations by every kCoarseStride-th place if that many edges are enough, else by all.
// 'enough': 0 to look at all places at once.
PatternLocator::Normal PatternLocator::Measure(const cv::Mat& image, const State& state,
                                               std::span<const Place> places, std::size_t enough,
                                               double reach_px, double min_step,
                                               double scale_px) const {
  if (enough > 0) {
    Normal normal = Accumulate(image, state, places, kCoarseStride, reach_px, min_step, scale_px);
    if (normal.used >= enough) return normal;
  }
  return Accumulate(image, state, places, 1, reach_px, min_step, scale_px);
}

// The state's step, a prior put to the normal equations first. The spread is held at none unless
// the edges leave no doubt: to ask for it always would cost a sixth of the accuracy where there is
// none, and a part of a print bends to what is beside it.
PatternLocator::Vector PatternLocator::Solve(const State& state,
                                             const std::optional<NormalPrior>& prior,
                                             bool has_spread, Normal* normal) {
  if (prior) {
    const Residuals residuals(*normal, Vector::Zero());
    prior->AddTo(state.pose.rotation, residuals.EdgeVariance(), &normal->h, &normal->g);
  }
  if (has_spread && !normal->IsPart()) {
    const Eigen::LDLT<Matrix> decomposition(normal->h);
    Vector step = decomposition.solve(normal->g);
    const double variance = Residuals(*normal, step).EdgeVariance() *
                            decomposition.solve(Vector::Unit(kSpread))(kSpread);
    const double least = std::max(kLeastSpreadPx, kSureSpread * std::sqrt(variance));
    if (std::abs(state.spread_px + step(kSpread)) > least) return step;
  }
  normal->h(kSpread, kSpread) += kHeld;
  normal->g(kSpread) -= kHeld * state.spread_px;
  return normal->h.ldlt().solve(normal->g);
}

// What 'step' leaves of the offsets makes the covariance of the pose.
void PatternLocator::Describe(const Normal& normal, const Vector& step, PatternLocation* location) {
  const Residuals residuals(normal, step);
  const Matrix inverse = normal.h.ldlt().solve(Matrix::Identity().eval());
  const Eigen::Matrix<double, 6, 1> blur = kBlurSpreadPx2 * (inverse * normal.by_blur).head<6>();
  location->covariance =
      residuals.EdgeVariance() * inverse.topLeftCorner<6, 6>() + blur * blur.transpose();
  location->edge_rms_px = std::sqrt(residuals.MeanSquare());
  location->edge_share = residuals.used / std::max(1, normal.in_image);
  location->edges = static_cast<int>(normal.used);
  for (int part = 0; part < 8; ++part) {
    const int seen = normal.part_in_image[part];
    const double share = 4 * seen < normal.part_places[part]
                             ? -1.0
                             : static_cast<double>(residuals.part_used[part]) / seen;
    (part < 4 ? location->arm_share : location->ring_share)[part % 4] = share;
  }
}

std::optional<PatternLocation> PatternLocator::Locate(
    const cv::Mat& image, const RigidTransform& initial, double reach_px, double min_step,
    int iterations, const std::optional<NormalPrior>& prior) const {
  PatternLocation location;
  State state{initial};
  double scale = std::max(1.0, 0.5 * reach_px);
  double reach = reach_px;
  for (int iteration = 1; iteration <= iterations + kMoreIterations; ++iteration) {
    // A part of the edges brings the pose near, all of them say where it is.
    const bool coarse = iteration < iterations;
    Normal normal = Measure(image, state, places_, coarse ? kFewEdges : 0, reach, min_step, scale);
    if (normal.used < kMinEdges) return std::nullopt;
    const Vector step = Solve(state, prior, iteration + 1 >= iterations, &normal);
    if (!state.Move(step)) return std::nullopt;
    scale = std::clamp(normal.RobustScale(), 0.25, scale);
    reach = std::clamp(3 * scale, 1.5, reach);
    if (coarse) continue;
    const bool settled = normal.Movement(step) < kSettledPx;
    if (settled || iteration == iterations + kMoreIterations) Describe(normal, step, &location);
    // The tilt of a pattern that is seen from straight above moves the edges by its square only:
    // there the steps are short of the goal.
    if (settled) break;
  }
  if (!location.covariance.allFinite()) return std::nullopt;
  location.camera_from_pattern = state.pose;
  return location;
}

std::optional<RigidTransform> PatternLocator::LocateRing(
    const cv::Mat& image, const RigidTransform& initial, double reach_px, double min_step,
    int iterations, const std::optional<NormalPrior>& prior) const {
  State state{initial};
  double scale = std::max(1.0, 0.5 * reach_px);
  double reach = reach_px;
  const std::span<const Place> places = std::span(places_).first(ring_places_);
  const auto whole = static_cast<std::size_t>(kWholeRing * places.size() / kCoarseStride);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Normal normal = Measure(image, state, places, whole, reach, min_step, scale);
    if (normal.used < kMinEdges) return std::nullopt;
    // A ring says nothing about turns in its plane, and a short arc little about its far side.
    normal.h.diagonal() *= 1 + 1e-4;
    const double weight = 1e-6 * normal.h.diagonal().segment<3>(3).maxCoeff();
    for (int i = 3; i < 6; ++i) normal.h(i, i) += weight;
    const Vector step = Solve(state, prior, false, &normal);
    if (!state.Move(step)) return std::nullopt;
    const double before = std::exchange(scale, std::clamp(normal.RobustScale(), 0.25, scale));
    reach = std::clamp(3 * scale, 1.5, reach);
    // The edges of anything but a ring stay scattered.
    const bool gathers = scale < kGathering * before && iteration + 1 < iterations;
    if (iteration > 0 && scale > kMaxRingScatterPx && !gathers) return std::nullopt;
    if (iteration > 0 && normal.Movement(step) < kRingSettledPx) break;
  }
  return state.pose;
}

}  // namespace kestrel
