// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/search/pad_alignment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/image/gray_sampling.h"
#include "kestrel/vision/search/edge_place.h"

namespace kestrel {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr int kProfile = kEdgeProfile;
constexpr double kReach = 0.5;      // share of the stroke, on either side of an edge
constexpr double kMostReachPx = 6;  // at last; four times as far at first
constexpr int kHalvings = 2;  // steps of the reach, each once edges move by less than a fourth
constexpr double kLeastReachPx = 1.2;
constexpr double kFineStrokePx = 8;  // strokes whose fine edges are looked at, too
constexpr std::size_t kLeastEdges = 12;
constexpr double kFloorPx = 0.06;  // noise of an edge's place that stays however sharp it is
constexpr double kOutlier = 4;     // standard deviations
// Edges found anywhere within the reach are 0.4 to 0.58 of it off: such a pose explains none.
constexpr double kMostRmsPx = 0.35 * kMostReachPx;
constexpr double kMostTurn = 0.3;    // largest rotation in a step, rad
constexpr double kConverged = 1e-5;  // rad
constexpr int kIterations = 12;

// The normal equations of one step.
struct NormalEquations {
  Matrix6 information = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  double cost = 0;

  void Add(const Eigen::Matrix<double, 1, 6>& derivative, double residual, double weight) {
    information += weight * derivative.transpose() * derivative;
    gradient += weight * residual * derivative.transpose();
    cost += 0.5 * weight * residual * residual;
  }
};

void AddPrior(const RigidTransform& pose, const LevelPrior& prior, NormalEquations* equations) {
  if (!prior.up_in_camera) return;
  const Eigen::Vector3d face = pose.rotation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d first = prior.up_in_camera->unitOrthogonal();
  const double weight = 1 / (prior.sigma * prior.sigma);
  for (const Eigen::Vector3d& axis : {first, Eigen::Vector3d(prior.up_in_camera->cross(first))}) {
    Eigen::Matrix<double, 1, 6> derivative = Eigen::Matrix<double, 1, 6>::Zero();
    derivative.tail<3>() = face.cross(axis).transpose();
    equations->Add(derivative, -axis.dot(face), weight);
  }
}

// Returns how far (px) a step moves the edge that it moves farthest.
double MostMoved(const std::vector<PadAlignmentBuffers::Equation>& equations, const Vector6& step) {
  double most = 0;
  for (const PadAlignmentBuffers::Equation& equation : equations) {
    if (!std::isnan(equation.residual_px)) {
      most = std::max(most, std::abs(equation.derivative.dot(step)));
    }
  }
  return most;
}

}  // namespace

double CostAbove(const AlignedPad& best, const AlignedPad& other) {
  const double sigma = std::max(kFloorPx, best.rms_px);
  const double squares =
      (other.rms_px * other.rms_px - best.rms_px * best.rms_px) / (sigma * sigma);
  return 0.5 * best.edges * squares + other.prior_cost - best.prior_cost;
}

double PadPart::StrokePx(const CameraModel& camera, const RigidTransform& camera_from_pad) const {
  const Eigen::Vector3d place = camera_from_pad * Eigen::Vector3d(center.x(), center.y(), 0);
  const Eigen::Vector3d face = camera_from_pad.rotation * Eigen::Vector3d::UnitZ();
  const double distance = place.norm();
  const double slant = -face.dot(place) / distance;
  return std::max(0.0, slant) * camera.intrinsics().fx_px * stroke_m / distance;
}

void PadAlignment::Reserve(PadAlignmentBuffers* buffers) const {
  PadAlignmentBuffers& b = *buffers;
  std::size_t most = 0;
  for (const PadPart* part : parts_) most += part->edges.size();
  b.edges.reserve(most);
  for (std::vector<float>* column : {&b.x, &b.y, &b.z, &b.u, &b.v}) column->resize(most);
  for (std::vector<float>& column : b.derivative) column.resize(most);
  for (std::vector<float>* column : {&b.profile_u, &b.profile_v, &b.gray}) {
    column->resize(most * kProfile);
  }
  b.equations.reserve(most);
  b.magnitudes.reserve(most);
}

void PadAlignment::CollectEdges(const RigidTransform& pose, const PadPart* only,
                                PadAlignmentBuffers* buffers) const {
  buffers->edges.clear();
  for (const PadPart* part : parts_) {
    if (only != nullptr && part != only) continue;
    const double stroke_px = part->StrokePx(camera_, pose);
    if (stroke_px < PadPart::kLeastStrokePx) continue;
    for (const PadEdge& edge : part->edges) {
      if (!edge.fine || stroke_px >= kFineStrokePx) buffers->edges.push_back(&edge);
    }
  }
}

void PadAlignment::Predict(const RigidTransform& pose, double most_reach_px,
                           PadAlignmentBuffers* buffers) const {
  PadAlignmentBuffers& b = *buffers;
  const std::size_t count = b.edges.size();
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d& place = b.edges[i]->place;
    const Eigen::Vector3f point = (rotation.leftCols<2>() * place + pose.translation).cast<float>();
    b.x[i] = point.x();
    b.y[i] = point.y();
    b.z[i] = point.z();
  }
  std::array<float*, 6> columns;
  for (std::size_t k = 0; k < columns.size(); ++k) columns[k] = b.derivative[k].data();
  camera_.ProjectMany({b.x.data(), b.y.data(), b.z.data()}, count, b.u.data(), b.v.data(),
                      &columns);
  b.equations.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const PadEdge& edge = *b.edges[i];
    Eigen::Matrix<double, 2, 3> by_point;
    for (int k = 0; k < 6; ++k) by_point(k / 3, k % 3) = b.derivative[k][i];
    const Eigen::Matrix2d by_place = by_point * rotation.leftCols<2>();
    const Eigen::Vector2d along = by_place * Eigen::Vector2d(-edge.to_white.y(), edge.to_white.x());
    Eigen::Vector2d normal = Eigen::Vector2d(-along.y(), along.x()).normalized();
    double stroke_px = normal.dot(by_place * edge.to_white) * edge.stroke_m;
    if (stroke_px < 0) {
      normal = -normal;
      stroke_px = -stroke_px;
    }
    const double reach = std::clamp(kReach * stroke_px, kLeastReachPx, most_reach_px);
    const Eigen::RowVector3d by_translation = normal.transpose() * by_point;
    const Eigen::Vector3d arm = rotation.leftCols<2>() * edge.place;
    PadAlignmentBuffers::Equation equation;
    equation.derivative << by_translation, arm.cross(by_translation.transpose()).transpose();
    equation.reach_px = static_cast<float>(reach);
    equation.residual_px = NAN;
    b.equations.push_back(equation);
    for (int k = 0; k < kProfile; ++k) {
      const double offset = reach * (2.0 * k / (kProfile - 1) - 1);
      b.profile_u[i * kProfile + k] = static_cast<float>(b.u[i] + offset * normal.x());
      b.profile_v[i * kProfile + k] = static_cast<float>(b.v[i] + offset * normal.y());
    }
  }
}

void PadAlignment::Measure(const cv::Mat& image, PadAlignmentBuffers* buffers) const {
  PadAlignmentBuffers& b = *buffers;
  SampleGrays(image, b.profile_u.data(), b.profile_v.data(), b.edges.size() * kProfile,
              b.gray.data());
  b.magnitudes.clear();
  for (std::size_t i = 0; i < b.equations.size(); ++i) {
    PadAlignmentBuffers::Equation& equation = b.equations[i];
    equation.residual_px =
        EdgePlace(std::span<const float, kProfile>(b.gray.data() + i * kProfile, kProfile),
                  equation.reach_px);
    if (!std::isnan(equation.residual_px)) b.magnitudes.push_back(std::abs(equation.residual_px));
  }
}

std::optional<AlignedPad> PadAlignment::Align(const cv::Mat& image, const RigidTransform& start,
                                              const LevelPrior& prior, const PadPart* only,
                                              PadAlignmentBuffers* buffers) const {
  AlignedPad aligned;
  aligned.camera_from_pad = start;
  CollectEdges(start, only, buffers);
  int halvings = 0;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    RigidTransform& pose = aligned.camera_from_pad;
    const double most_reach_px = kMostReachPx * (1 << (kHalvings - halvings));
    Predict(pose, most_reach_px, buffers);
    Measure(image, buffers);
    if (buffers->magnitudes.size() < kLeastEdges) return std::nullopt;
    const double sigma = std::max(kFloorPx, RobustSigmaInPlace(buffers->magnitudes));
    NormalEquations equations;
    AddPrior(pose, prior, &equations);
    aligned.prior_cost = equations.cost;
    aligned.edges = 0;
    double squares = 0;
    for (const PadAlignmentBuffers::Equation& equation : buffers->equations) {
      // Tukey's weights: what is far off is no edge of the pad.
      const double share = equation.residual_px / (kOutlier * sigma);
      if (!(std::abs(share) < 1)) continue;
      const double weight = (1 - share * share) * (1 - share * share) / (sigma * sigma);
      equations.Add(equation.derivative, equation.residual_px, weight);
      squares += equation.residual_px * equation.residual_px;
      ++aligned.edges;
    }
    if (aligned.edges < static_cast<int>(kLeastEdges)) return std::nullopt;
    aligned.rms_px = std::sqrt(squares / aligned.edges);
    const Eigen::LDLT<Matrix6> solver(equations.information);
    Vector6 step = solver.solve(equations.gradient);
    if (!step.allFinite()) return std::nullopt;
    // The image hardly shows the tilt of a far pad: what it suggests at first is no guide.
    step *= kMostTurn / std::max(kMostTurn, step.tail<3>().norm());
    aligned.covariance = solver.solve(Matrix6::Identity());
    pose = Moved(pose, step.head<3>(), step.tail<3>());
    const double moved = step.head<3>().norm() / pose.translation.norm() + step.tail<3>().norm();
    if (halvings == kHalvings && moved < kConverged) break;
    // An edge out of reach is not seen: the reach stays while the edges still move far.
    if (halvings < kHalvings && MostMoved(buffers->equations, step) < 0.25 * most_reach_px) {
      ++halvings;
    }
  }
  if (halvings < kHalvings || aligned.rms_px > kMostRmsPx) return std::nullopt;
  return aligned;
}

}  // namespace kestrel
