// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/search_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kestrel {
namespace {

using Eigen::Vector2d;

constexpr double kReached_m = 3;
// Distance between the turns of the spiral per metre of altitude: a fisheye sees that far to all
// sides.
constexpr double kSpacing = 1;

}  // namespace

void SearchPath::Start(const Vector2d& place, const Extent& extent) {
  place_ = place;
  extent_ = extent;
  waited_s_ = 0;
  angle_ = 0;
}

Vector2d SearchPath::Advance(const Vector2d& uav, double seconds) {
  Vector2d point = Point();
  const bool keeps_up = (point - uav).norm() < kReached_m;
  if (extent_.radius_m == 0 || !keeps_up) return point;
  if (waited_s_ < extent_.wait_s) {
    waited_s_ += seconds;
    return point;
  }
  const double widening = kSpacing * options_.search_altitude_m / (2 * std::numbers::pi);
  const double radius_m = widening * angle_;
  angle_ += options_.search_speed_mps * seconds / std::hypot(radius_m, widening);
  if (widening * angle_ > extent_.radius_m) Start(place_, extent_);
  return Point();
}

Vector2d SearchPath::Point() const {
  const double widening = kSpacing * options_.search_altitude_m / (2 * std::numbers::pi);
  return place_ + widening * angle_ * Vector2d(std::cos(angle_), std::sin(angle_));
}

}  // namespace kestrel
