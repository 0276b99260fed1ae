// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/search/prior_knowledge.h"

#include <algorithm>
#include <cmath>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/target/part_below_horizon.h"

namespace kestrel {
namespace {

// Least cosine between up and the normal of a ring. Below it, a wrong attitude is more likely than
// a pattern on edge.
constexpr double kCredibleTilt = 0.7;
// Difference of two such cosines below which both poses count as equally level.
constexpr double kAlikeTilt = 0.05;
// Log odds of a pattern at another distance than that of the hint.
constexpr double kWrongDistance = -2;

}  // namespace

PriorKnowledge::PriorKnowledge(const TargetHint& hint, const LandingPatternDetectorOptions& options,
                               const CameraModel& camera)
    : hint_(hint),
      camera_(camera),
      radius_m_(options.pattern.outer_radius_m()),
      level_sigma_(Radians(options.level_sigma_deg)),
      max_partial_altitude_m_(options.max_partial_altitude_m) {
  if (hint.center_in_camera && hint.center_in_camera->norm() > 0) {
    expected_ring_px_ = ExpectedRingPx();
  }
}

double PriorKnowledge::ExpectedRingPx() const {
  const Eigen::Vector3d& center = *hint_.center_in_camera;
  const Eigen::Vector3d across = radius_m_ * center.unitOrthogonal();
  Eigen::Vector2d a, b;
  if (camera_.Project(center + across, &a) == ProjectionStatus::kOutsideModel ||
      camera_.Project(center - across, &b) == ProjectionStatus::kOutsideModel) {
    return 2 * camera_.intrinsics().fx_px * std::atan2(radius_m_, center.norm());
  }
  return (a - b).norm();
}

std::optional<cv::Rect> PriorKnowledge::PartOfImage(double sigma_m) const {
  Eigen::Vector2d pixel;
  if (expected_ring_px_ == 0 ||
      camera_.Project(*hint_.center_in_camera, &pixel) == ProjectionStatus::kOutsideModel) {
    return std::nullopt;
  }
  const double px_per_m = camera_.intrinsics().fx_px / hint_.center_in_camera->norm();
  // Half the width of the board, plus three standard deviations of its centre.
  const double reach = 1.2 * expected_ring_px_ + 3 * sigma_m * px_per_m + 8;
  if (!(reach < 1e6 && pixel.norm() < 1e6)) return std::nullopt;
  // Whole tiles of the coarsest pass, so that the part is thresholded as in the whole image.
  constexpr int kAlign = 32;
  const auto align = [](double value) {
    return static_cast<int>(std::floor(value / kAlign)) * kAlign;
  };
  const int x0 = std::max(0, align(pixel.x() - reach));
  const int y0 = std::max(0, align(pixel.y() - reach));
  const int x1 = std::min(camera_.width_px(), align(pixel.x() + reach) + kAlign);
  const int y1 = std::min(camera_.height_px(), align(pixel.y() + reach) + kAlign);
  if (x1 - x0 < kAlign || y1 - y0 < kAlign) return std::nullopt;
  return cv::Rect(x0, y0, x1 - x0, y1 - y0);
}

std::optional<cv::Rect> PriorKnowledge::PartBelowHorizon() const {
  if (!hint_.up_in_camera || !hint_.sky_above_rad) return std::nullopt;
  return kestrel::PartBelowHorizon(camera_, *hint_.up_in_camera, *hint_.sky_above_rad);
}

std::optional<CirclePose> PriorKnowledge::PredictedRing() const {
  if (!hint_.center_in_camera || !hint_.up_in_camera) return std::nullopt;
  const CirclePose ring{*hint_.center_in_camera, *hint_.up_in_camera};
  // Excludes a view from below, and NaN.
  if (!(ring.center.dot(ring.normal) < 0)) return std::nullopt;
  return ring;
}

bool PriorKnowledge::Suits(const SearchStep& step) const {
  const SearchPass& pass = kPasses[step.pass];
  // In the coarsest passes rings seem too small.
  if (expected_ring_px_ > 0 && (1.5 * pass.min_ring_px > expected_ring_px_ ||
                                expected_ring_px_ > SearchPass::kWidest * pass.max_ring_px)) {
    return false;
  }
  return step.method != SearchMethod::kCross || !hint_.altitude_m ||
         *hint_.altitude_m <= max_partial_altitude_m_;
}

double PriorKnowledge::LogOddsOfDistance(const Eigen::Vector3d& center) const {
  const double distance = center.norm();
  if (hint_.center_in_camera) {
    const double expected = hint_.center_in_camera->norm();
    const double tolerance = 0.25 * expected + 3 * hint_.center_sigma_m;
    if (!(std::abs(distance - expected) <= tolerance)) return kWrongDistance;
  }
  if (!hint_.altitude_m) return 0;
  // The altitude may be above the ground, while the pattern is on a vehicle.
  constexpr double kMaxVehicleHeight = 3;
  const double below = hint_.up_in_camera ? -hint_.up_in_camera->dot(center) : distance;
  const bool near_enough = !hint_.up_in_camera || below <= 1.4 * *hint_.altitude_m + 1;
  const bool far_enough = below >= 0.7 * *hint_.altitude_m - kMaxVehicleHeight;
  return near_enough && far_enough ? 0 : kWrongDistance;
}

PriorKnowledge::Order PriorKnowledge::OrderOf(const std::array<CirclePose, 2>& poses) const {
  Order order;
  if (!hint_.up_in_camera) return order;
  const double a = poses[0].normal.dot(*hint_.up_in_camera);
  const double b = poses[1].normal.dot(*hint_.up_in_camera);
  if (b > a) std::swap(order.poses[0], order.poses[1]);
  order.one_is_right = std::max(a, b) > kCredibleTilt && std::abs(a - b) > kAlikeTilt;
  return order;
}

std::optional<NormalPrior> PriorKnowledge::LevelPrior(const Eigen::Vector3d& normal) const {
  if (!hint_.up_in_camera || !(normal.dot(*hint_.up_in_camera) > kCredibleTilt)) {
    return std::nullopt;
  }
  return NormalPrior{*hint_.up_in_camera, level_sigma_};
}

Eigen::Vector3d PriorKnowledge::Up() const {
  return hint_.up_in_camera.value_or(-Eigen::Vector3d::UnitZ());
}

}  // namespace kestrel
