// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/stay_on_deck.h"

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/flight/guidance/since.h"

namespace kestrel {
namespace {

constexpr double kStanding_mps = 0.5;  // a slower deck stands,
constexpr double kStood_s = 5;         // and has stopped for good after so long

}  // namespace

void StayOnDeck::Reset() {
  ride_.Reset();
  carried_.Reset();
  stands_since_.reset();
}

SetPoint StayOnDeck::Rest(Time now, const Eigen::Quaterniond& world_from_body,
                          const Eigen::Vector3d& velocity, double delay_s) {
  ride_.Observe(now, velocity.head<2>());
  Remember(velocity.head<2>().norm() < kStanding_mps, now, &stands_since_);
  carried_.Observe(
      now, {world_from_body * Eigen::Vector3d::UnitZ(), ride_.acceleration(), velocity.z()});
  SetPoint command;
  command.velocity << ride_.Velocity(delay_s), -options_.touchdown_sink_mps;
  command.acceleration.head<2>() = ride_.acceleration();
  command.yaw = HeadingOf(world_from_body);  // a deck that turns turns it
  command.is_carried = true;
  return command;
}

GuidanceRequest StayOnDeck::Request(Time now, bool is_landed,
                                    const std::optional<Time>& touches_since) const {
  const bool has_waited =
      options_.disarm_after_s > 0 && IsLongerThan(options_.disarm_after_s, touches_since, now);
  // An autopilot that has found the ground disarms by itself.
  const bool is_carried = options_.disarm_carried_s > 0 && !is_landed &&
                          carried_.seconds() >= options_.disarm_carried_s;
  if (has_waited || is_carried) return GuidanceRequest::kDisarm;
  // LAND would brake on a deck that moves or starts, unless the autopilot has found that it has
  // landed: until then the set-points go on.
  const bool may_land = is_landed || IsLongerThan(kStood_s, stands_since_, now);
  return options_.land_in_contact && may_land ? GuidanceRequest::kLand : GuidanceRequest::kNone;
}

}  // namespace kestrel
