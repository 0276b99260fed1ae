// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/gimbal_pointing.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr double kDown = kPi / 2;
constexpr double kFar_m = 4;  // height above the target from which it is no longer close

// The yaw offset of a search after 'swept' rad: once around, or to both limits and back.
double SweepYaw(double swept, double side) {
  if (side >= kPi) return swept;
  if (swept < side) return swept;
  return swept < 3 * side ? 2 * side - swept : swept - 4 * side;
}

double SweepLength(double side) { return side >= kPi ? 2 * kPi : 4 * side; }

}  // namespace

GimbalAngles GimbalPointing::Update(const PointingInput& input) {
  const double seconds = last_ ? ToSeconds(input.now - *last_) : 0;
  last_ = input.now;
  const double heading = HeadingOf(input.world_from_pivot.rotation);
  const Vector3d& pivot = input.world_from_pivot.translation;
  if (!held_yaw_) held_yaw_ = heading;
  if (!input.target) {
    if (StaysDown(pivot.z() - ground_m_)) return WithinRange(*held_yaw_, kDown, heading);
    if (step_ != PointingStep::kSearch) BeginCircle(0);
    step_ = PointingStep::kSearch;
    return Search(pivot.z() - ground_m_, heading, seconds);
  }
  ground_m_ = input.target->z();
  const Vector3d ray = *input.target - pivot;
  step_ = IsClose(ray) ? PointingStep::kDown : PointingStep::kTarget;
  if (step_ == PointingStep::kDown) return WithinRange(*held_yaw_, kDown, heading);
  return PointAt(ray, heading);
}

// After contact nothing is seen, and the target is still below.
bool GimbalPointing::StaysDown(double height_m) const {
  return step_ == PointingStep::kDown && height_m < kFar_m;
}

// True near the target where all of it is in the view straight down, and from then on until the
// target leaves that view.
bool GimbalPointing::IsClose(const Vector3d& ray) const {
  constexpr double kNear_m = 3, kLeast_m = 1;
  constexpr double kPart = 0.8;  // of the view
  const double height_m = -ray.z();
  const double aside_m = ray.head<2>().norm();
  if (step_ == PointingStep::kDown) {
    return height_m < kFar_m &&
           std::atan2(aside_m, std::max(height_m, kLeast_m)) < view_.half_angle;
  }
  return height_m > 0 && height_m < kNear_m &&
         std::atan2(aside_m + 0.5 * view_.pad_size_m, height_m) < kPart * view_.half_angle;
}

// Near the vertical the yaw would turn around with every step aside: it is held, and the pitch
// follows in its plane. What is off to the side then is small against the view.
GimbalAngles GimbalPointing::PointAt(const Vector3d& ray, double heading) {
  constexpr double kLeave = 1.3;
  const double steep = std::min(Radians(20.0), 0.5 * view_.half_angle);
  const double off_vertical = std::atan2(ray.head<2>().norm(), -ray.z());
  is_steep_ = off_vertical < (is_steep_ ? kLeave * steep : steep);
  if (!is_steep_) held_yaw_ = std::atan2(ray.y(), ray.x());
  const double ahead = ray.x() * std::cos(*held_yaw_) + ray.y() * std::sin(*held_yaw_);
  return WithinRange(*held_yaw_, std::atan2(-ray.z(), ahead), heading);
}

GimbalAngles GimbalPointing::WithinRange(double yaw, double axis_pitch, double heading) const {
  const double off = std::remainder(yaw - heading, 2 * kPi);
  return {heading + std::clamp(off, -range_.side, range_.side),
          std::clamp(axis_pitch - view_.axis_pitch, range_.highest, range_.lowest)};
}

void GimbalPointing::BeginCircle(int circle) {
  circle_ = circle;
  searched_ = 0;
}

GimbalAngles GimbalPointing::Search(double height_m, double heading, double seconds) {
  constexpr double kLook_s = 2;             // straight down, before each round
  constexpr double kSweep = Radians(30.0);  // 1/s: faster, images blur
  constexpr double kMostYaw = Radians(60.0);
  constexpr double kMostOff = Radians(80.0);  // from the vertical
  constexpr double kOverlap = 0.8;
  const double reach = kOverlap * view_.half_angle;
  const double part = std::clamp(height_m / std::max(view_.sight_range_m, 1e-3), 0.0, 1.0);
  const double farthest = std::min(std::acos(part), kMostOff);
  const int circles = farthest > view_.half_angle
                          ? static_cast<int>(std::ceil((farthest - reach) / (2 * reach)))
                          : 0;
  held_yaw_ = heading;
  if (circle_ > circles) BeginCircle(0);
  if (circle_ == 0) {
    searched_ += seconds;
    if (searched_ > kLook_s && circles > 0) BeginCircle(1);
    return WithinRange(heading, kDown, heading);
  }
  const double off_vertical = circle_ * (farthest - reach) / circles;
  searched_ += seconds * std::min(kSweep / std::sin(off_vertical), kMostYaw);
  const double yaw = heading + SweepYaw(searched_, range_.side);
  if (searched_ > SweepLength(range_.side)) BeginCircle(circle_ + 1);
  return WithinRange(yaw, kDown - off_vertical, heading);
}

}  // namespace kestrel
