// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/follow_guidance.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/poses/gravity.h"
#include "kestrel/flight/guidance/since.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kCoast_s = 1;    // the UAV flies on by the prediction alone for no longer
constexpr double kResume_s = 10;  // lost for longer, following needs a new confirmation
// Parts of the distance: the largest standard deviation of the target's place to begin with, and to
// go on with; and the errors of the distance below which it is following, and beyond which not.
constexpr double kKnown = 0.2, kStillKnown = 0.3;
constexpr double kNear = 0.1, kFar = 0.2;
constexpr double kLeastWay_m = 1;  // nearer to the target the nose stays as it is

Vector2d WayTo(const TargetEstimate& target, const UavState& uav) {
  return Vector2d(target.motion.position().head<2>()) - uav.world_from_body.translation.head<2>();
}

// Returns the options with a braking for which a fixed camera, at its place beside the target, does
// not lose it.
GuidanceOptions WithinView(GuidanceOptions options, const std::optional<ViewLimits>& view) {
  constexpr double kShare = 0.6;  // the rest is for the target's own acceleration
  if (!view) return options;
  const ViewLimits::Leans leans =
      view->LeansFor(options.follow.distance_m, options.follow.height_m);
  const double most = kGravity * std::tan(std::min(leans.forward, leans.back));
  options.braking = std::min(options.braking, kShare * most);
  return options;
}

}  // namespace

FollowGuidance::FollowGuidance(const GuidanceOptions& options,
                               const std::optional<ViewLimits>& view)
    : Guidance(WithinView(options, view), std::nullopt), view_(view), stand_off_(options.follow) {
  const FollowOptions& follow = options.follow;
  const FlightLimitsOptions& limits = options.limits;
  if (!(follow.height_m >= limits.floor_m && follow.height_m <= limits.ceiling_m)) {
    throw InputError(
        fmt::format("follow.height_m is {:g}, expected {:g} (limits.floor_m) to {:g} "
                    "(limits.ceiling_m)",
                    follow.height_m, limits.floor_m, limits.ceiling_m));
  }
  if (!view || view->Sees(follow.distance_m, follow.height_m)) return;
  throw InputError(fmt::format(
      "follow.distance_m {:g}, follow.height_m {:g}: the camera, fixed as it is, does not look "
      "{:.0f} "
      "degrees down, where the target would be",
      follow.distance_m, follow.height_m, Degrees(std::atan2(follow.height_m, follow.distance_m))));
}

void FollowGuidance::Begin(const GuidanceInput& input) {
  confirmation_.Begin(input.order);
  yaw_ = HeadingOf(input.uav->world_from_body.rotation);
  Stop("waits for a mark, and for its confirmation");
}

Guidance::Wish FollowGuidance::Choose(const GuidanceInput& input) {
  if (input.is_landed) {
    End("the UAV is on the ground");
    return {};
  }
  ChoosePhase(input);
  const double seconds = SecondsSinceLast(input.now);
  TurnNose(input, seconds);
  Wish wish;
  wish.set_point = IsFollowing() ? Pursue(input) : Stay(input);
  wish.set_point.yaw = yaw_;
  wish.set_point.yaw_rate = yaw_rate_;
  LimitLean(input, seconds, &wish.set_point);
  return wish;
}

void FollowGuidance::ChoosePhase(const GuidanceInput& input) {
  const char* trouble = WhyNotFollow(input);
  TakeOrder(input, trouble);
  if (confirmation_.mark() == 0) return;
  Remember(trouble != nullptr, input.now, &lost_);
  if (IsLongerThan(kResume_s, lost_, input.now)) {
    confirmation_.Withdraw();
    return Stop("was lost for too long: needs a new confirmation");
  }
  if (trouble != nullptr) {
    if (IsFollowing()) Stop(trouble);
    return;
  }
  if (jump_.Update(input)) {
    confirmation_.Withdraw();
    return Stop("was seen again where it cannot be: needs a new confirmation");
  }
  if (!IsFollowing()) {
    stand_off_.Start(input.target->motion.position().head<2>(),
                     input.uav->world_from_body.translation.head<2>());
    pursuit().Reset();
    Enter(GuidancePhase::kApproach, "flies to what is marked");
  }
  const double error = DistanceError(input) / options().follow.distance_m;
  if (phase() == GuidancePhase::kApproach && error < kNear) {
    Enter(GuidancePhase::kFollow, "follows what is marked");
  } else if (phase() == GuidancePhase::kFollow && error > kFar) {
    Enter(GuidancePhase::kApproach, "too far from its distance");
  }
}

// Returns why the UAV may not fly to the target now, a literal; null: it may.
const char* FollowGuidance::WhyNotFollow(const GuidanceInput& input) {
  const bool is_seen = input.is_camera_up && input.target_age_s <= kCoast_s;
  if (!input.target || !is_seen)
    return "what is marked is lost: stands still until it is seen again";
  const double most = (IsFollowing() ? kStillKnown : kKnown) * options().follow.distance_m;
  if (!(input.target->position_sigma_m() <= most)) {
    return "the place of what is marked is too uncertain: stands still";
  }
  return nullptr;
}

void FollowGuidance::TakeOrder(const GuidanceInput& input, const char* trouble) {
  const char* refusal = "refused: what is marked is not seen, or its place is too uncertain";
  const char* reason =
      confirmation_.Update(input.order, input.mark, trouble != nullptr ? refusal : nullptr);
  if (confirmation_.is_new()) {
    lost_.reset();
    jump_.Reset();
  }
  if (reason != nullptr) Stop(reason);
}

void FollowGuidance::Stop(const char* reason) {
  stay_.reset();
  Enter(GuidancePhase::kLook, reason);
}

bool FollowGuidance::IsFollowing() const {
  return phase() == GuidancePhase::kApproach || phase() == GuidancePhase::kFollow;
}

double FollowGuidance::DistanceError(const GuidanceInput& input) const {
  return std::abs(WayTo(*input.target, *input.uav).norm() - options().follow.distance_m);
}

bool FollowGuidance::IsBehind(const GuidanceInput& input) const {
  return DistanceError(input) > kFar * options().follow.distance_m;
}

SetPoint FollowGuidance::Stay(const GuidanceInput& input) {
  const Vector3d& position = input.uav->world_from_body.translation;
  const Vector3d& velocity = input.uav->velocity_in_world;
  if (!stay_ && velocity.norm() < kHalted_mps) stay_ = position;
  SetPoint command;
  if (!stay_) return command;
  command = pursuit().To(stay_->head<2>(), {position.head<2>(), velocity.head<2>()},
                         &flight_model(), options().limits.max_speed_mps);
  command.velocity.z() = kHeightGain * (stay_->z() - position.z());
  return command;
}

SetPoint FollowGuidance::Pursue(const GuidanceInput& input) {
  const TurnState& target = input.target->motion;
  const Vector3d& position = input.uav->world_from_body.translation;
  const Vector3d& velocity = input.uav->velocity_in_world;
  stand_off_.Update({target.position().head<2>(), target.velocity().head<2>()}, position.head<2>(),
                    SecondsSinceLast(input.now));
  SetPoint command = pursuit().Beside(*input.target, stand_off_,
                                      {position.head<2>(), velocity.head<2>()}, &flight_model());
  const double height_m = position.z() - target.position().z();
  const double climb = kHeightGain * (options().follow.height_m - height_m);
  command.velocity.z() = std::max(climb, -stale().MaxSink(height_m, input.link_delay_s));
  return command;
}

// Relative to the line to the target the nose turns no faster than the options allow.
void FollowGuidance::TurnNose(const GuidanceInput& input, double seconds) {
  yaw_rate_ = 0;
  if (!input.target) return;
  const Vector2d way = WayTo(*input.target, *input.uav);
  if (way.norm() < kLeastWay_m) return;
  const Vector2d motion =
      (input.target->motion.velocity() - input.uav->velocity_in_world).head<2>();
  yaw_rate_ = (way.x() * motion.y() - way.y() * motion.x()) / way.squaredNorm();
  yaw_ += yaw_rate_ * seconds;
  const double most = Radians(options().max_turn_dps) * seconds;
  const double off = std::remainder(std::atan2(way.y(), way.x()) - yaw_, 2 * kPi);
  yaw_ += std::clamp(off, -most, most);
}

// A fixed camera turns with the UAV: accelerations, and changes of the velocity, are those for
// which the lean leaves the target in the image. What the lean against the air takes of it is not
// left for them.
void FollowGuidance::LimitLean(const GuidanceInput& input, double seconds,
                               SetPoint* set_point) const {
  if (!view_ || !input.target) return;
  const Vector3d& position = input.uav->world_from_body.translation;
  const Vector3d& velocity = input.uav->velocity_in_world;
  const ViewLimits::Leans leans = view_->LeansFor(
      WayTo(*input.target, *input.uav).norm(), position.z() - input.target->motion.position().z());
  const Vector2d most = kGravity * Vector2d(std::tan(leans.forward), std::tan(leans.side));
  const Vector2d least = -kGravity * Vector2d(std::tan(leans.back), std::tan(leans.side));
  const Eigen::Rotation2Dd nose(yaw_);
  const auto limited = [&](const Vector2d& in_world, const Vector2d& held) -> Vector2d {
    const Vector2d in_body = nose.inverse() * in_world;
    return nose * in_body.cwiseMax(least - held).cwiseMin(most - held);
  };
  set_point->acceleration.head<2>() = limited(set_point->acceleration.head<2>(), Vector2d::Zero());
  const auto air = model().air();
  const Vector2d against_air =
      air ? Vector2d(nose.inverse() * (air->drag * (velocity.head<2>() - air->wind)))
          : Vector2d::Zero();
  const Vector2d before = sent() ? sent()->velocity.head<2>() : velocity.head<2>();
  const double step_s = std::max(seconds, 1e-3);
  const Vector2d change = (set_point->velocity.head<2>() - before) / step_s;
  set_point->velocity.head<2>() = before + step_s * limited(change, against_air);
}

}  // namespace kestrel
