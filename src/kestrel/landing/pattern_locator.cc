// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/pattern_locator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "kestrel/landing/pattern_view.h"

namespace kestrel {
namespace {

constexpr int kMaxReach = 12;  // px
// Places per place that the first iterations look at: odd, so that both sides of the arms have
// some.
constexpr std::size_t kCoarseStride = 3;
constexpr int kFewEdges = 30;              // too few of those for a pose
constexpr float kLeastStep = 2;            // of an edge, gray values per pixel
constexpr float kStepInShadow = 0.3f;      // the same against the gray value on its bright side
constexpr double kOnEdgePx = 1.0;          // offset of an edge that is the outline's own
constexpr double kLensBlurPx = 0.7;        // of optics and pixels, standard deviation
constexpr double kMaxRingScatterPx = 1.5;  // after two iterations, standard deviation
constexpr double kEdgeSigma = 0.12;        // px, of an edge that fits perfectly

// Whether the image shows all that FindEdge looks at.
bool ShowsSearch(const cv::Mat& image, const Eigen::Vector2d& at, const Eigen::Vector2d& normal,
                 int reach) {
  const Eigen::Array2d span = (reach + 1.5) * normal.array().abs();
  return (at.array() - span >= 0).all() &&
         (at.array() + span <= Eigen::Array2d(image.cols - 1, image.rows - 1)).all();
}

// Offset (px) along the unit vector 'normal' from 'at' to the steepest rise of brightness within
// 'reach' pixels, all of which the image must show; nothing when there is none.
std::optional<double> FindEdge(const cv::Mat& image, const Eigen::Vector2d& at,
                               const Eigen::Vector2d& normal, int reach, float min_step) {
  std::array<float, 2 * kMaxReach + 4> gray;
  const int count = 2 * reach + 4;
  Eigen::Vector2f place = (at - (reach + 1.5) * normal).cast<float>();
  const Eigen::Vector2f step = normal.cast<float>();
  for (int i = 0; i < count; ++i, place += step) {
    gray[i] = SampleInside(image, place.x(), place.y());
  }
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
  const double before = gray[best] - gray[best - 1];
  const double here = best_rise;
  const double after = gray[best + 2] - gray[best + 1];
  const double curvature = before - 2 * here + after;
  const double shift =
      curvature < 0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0;
  return best - reach - 1 + shift;
}

// Moves a pose by a translation and a rotation vector about its origin; false when that is no small
// change.
bool Move(const Eigen::Matrix<double, 6, 1>& step, RigidTransform* pose) {
  if (!step.allFinite()) return false;
  const double angle = step.tail<3>().norm();
  if (angle > 1) return false;
  pose->translation += step.head<3>();
  if (angle > 1e-12) {
    pose->rotation =
        (Eigen::Quaterniond(Eigen::AngleAxisd(angle, step.tail<3>() / angle)) * pose->rotation)
            .normalized();
  }
  return true;
}

}  // namespace

// Normal equations of the pose, and the statistics of the residuals that made them.
struct PatternLocator::Normal {
  Eigen::Matrix<double, 6, 6> h = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> g = Eigen::Matrix<double, 6, 1>::Zero();
  double weighted_squares = 0;
  double weights = 0;
  int in_image = 0;
  int used = 0;
  std::array<int, 8> part_places{};  // by part: all, in the image, used
  std::array<int, 8> part_in_image{};
  std::array<int, 8> part_used{};
  std::array<float, 512> magnitudes;  // of all residuals that were found
  int found = 0;

  // Standard deviation of the residuals by the median of their magnitudes.
  double RobustScale() {
    const auto middle = magnitudes.begin() + found / 2;
    std::nth_element(magnitudes.begin(), middle, magnitudes.begin() + found);
    return 1.4826 * static_cast<double>(*middle);
  }
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
    places_.push_back({point, sign * direction, 4 + quarter, sign / radius});
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
    for (int i = 0; i < kPerSide; ++i) {
      const double reach = first + (last - first) * i / (kPerSide - 1);
      for (const double side : {1.0, -1.0}) {
        places_.push_back({reach * along + side * half_width * across, side * across, arm, 0});
      }
    }
  }
}

// Adds what each 'stride'-th place says to the normal equations, weighted by Tukey's function of
// its residual with the given scale.
void PatternLocator::Accumulate(const cv::Mat& image, const RigidTransform& pose,
                                std::span<const Place> places, std::size_t stride, double reach_px,
                                double min_step, double scale_px, Normal* normal) const {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  const Eigen::Matrix<double, 3, 2> plane = rotation.leftCols<2>();
  const int reach = std::clamp(static_cast<int>(std::ceil(reach_px)), 1, kMaxReach);
  Eigen::Matrix<double, 2, 3> d_pixel;
  for (std::size_t i = 0; i < places.size(); i += stride) {
    const Place& place = places[i];
    ++normal->part_places[place.part];
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
    ++normal->in_image;
    ++normal->part_in_image[place.part];
    std::optional<double> offset =
        FindEdge(image, pixel, across, reach, static_cast<float>(min_step));
    if (!offset) continue;
    // Blur moves a bent edge towards the middle of the bend.
    const double shrink = 0.5 * kLensBlurPx * kLensBlurPx * place.curvature *
                          std::abs(d_plane.determinant()) /
                          (tangent.squaredNorm() * tangent.norm());
    *offset += shrink;
    if (normal->found < static_cast<int>(normal->magnitudes.size())) {
      normal->magnitudes[normal->found++] = static_cast<float>(std::abs(*offset));
    }
    const double ratio = *offset / (4 * scale_px);
    if (std::abs(ratio) >= 1) continue;
    const double weight = (1 - ratio * ratio) * (1 - ratio * ratio);
    Eigen::Matrix<double, 6, 1> jacobian;
    const Eigen::Vector3d d_point = d_pixel.transpose() * across;
    jacobian.head<3>() = d_point;
    jacobian.tail<3>() = from_center.cross(d_point);
    const Eigen::Matrix<double, 6, 1> weighted = weight * jacobian;
    normal->h.noalias() += weighted * jacobian.transpose();
    normal->g += *offset * weighted;
    normal->weighted_squares += weight * *offset * *offset;
    normal->weights += weight;
    ++normal->used;
    normal->part_used[place.part] += std::abs(*offset) <= kOnEdgePx;
  }
}

std::optional<PatternLocation> PatternLocator::Locate(const cv::Mat& image,
                                                      const RigidTransform& initial,
                                                      double reach_px, double min_step,
                                                      int iterations) const {
  PatternLocation location;
  location.camera_from_pattern = initial;
  RigidTransform& pose = location.camera_from_pattern;
  double scale = std::max(1.0, 0.5 * reach_px);
  double reach = reach_px;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Normal normal;
    // A part of the edges brings the pose near, all of them say where it is.
    const bool last = iteration + 1 == iterations;
    if (!last) Accumulate(image, pose, places_, kCoarseStride, reach, min_step, scale, &normal);
    if (last || normal.used < kFewEdges) {
      normal = Normal();
      Accumulate(image, pose, places_, 1, reach, min_step, scale, &normal);
    }
    if (normal.used < 12) return std::nullopt;
    const auto solver = normal.h.ldlt();
    if (!Move(solver.solve(normal.g), &pose)) return std::nullopt;
    scale = std::clamp(normal.RobustScale(), 0.25, scale);
    reach = std::clamp(3 * scale, 1.5, reach);
    if (!last) continue;

    const double variance =
        std::max(kEdgeSigma * kEdgeSigma, normal.weighted_squares / normal.weights);
    location.covariance = variance * solver.solve(Eigen::Matrix<double, 6, 6>::Identity().eval());
    location.edge_rms_px = std::sqrt(normal.weighted_squares / normal.weights);
    location.edge_share = static_cast<double>(normal.used) / std::max(1, normal.in_image);
    location.edges = normal.used;
    for (int part = 0; part < 8; ++part) {
      const int seen = normal.part_in_image[part];
      const double share = 4 * seen < normal.part_places[part]
                               ? -1.0
                               : static_cast<double>(normal.part_used[part]) / seen;
      (part < 4 ? location.arm_share : location.ring_share)[part % 4] = share;
    }
  }
  if (!location.covariance.allFinite()) return std::nullopt;
  return location;
}

std::optional<RigidTransform> PatternLocator::LocateRing(const cv::Mat& image,
                                                         const RigidTransform& initial,
                                                         double reach_px, double min_step,
                                                         int iterations) const {
  RigidTransform pose = initial;
  double scale = std::max(1.0, 0.5 * reach_px);
  double reach = reach_px;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Normal normal;
    Accumulate(image, pose, std::span(places_).first(ring_places_), 1, reach, min_step, scale,
               &normal);
    if (normal.used < 12) return std::nullopt;
    // A ring says nothing about turns in its plane, and a short arc little about its far side.
    normal.h.diagonal() *= 1 + 1e-4;
    const double weight = 1e-6 * normal.h.diagonal().tail<3>().maxCoeff();
    for (int i = 3; i < 6; ++i) normal.h(i, i) += weight;
    if (!Move(normal.h.ldlt().solve(normal.g), &pose)) {
      return std::nullopt;
    }
    scale = std::clamp(normal.RobustScale(), 0.25, scale);
    reach = std::clamp(3 * scale, 1.5, reach);
    // The edges of anything but a ring stay scattered.
    if (iteration == 1 && scale > kMaxRingScatterPx) return std::nullopt;
  }
  return pose;
}

}  // namespace kestrel
