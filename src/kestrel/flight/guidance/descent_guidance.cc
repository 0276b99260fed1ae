// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/descent_guidance.h"

#include <algorithm>
#include <cmath>

namespace kestrel {

using Eigen::Vector2d;
using Eigen::Vector3d;

DescentGuidance::DescentGuidance(const GuidanceOptions& options,
                                 const std::optional<Vector2d>& place)
    : Guidance(options, place), search_(options) {}

DescentGuidance::Situation DescentGuidance::Look(const GuidanceInput& input) const {
  Situation now;
  now.feet = input.uav->world_from_body * Vector3d(0, 0, -options().leg_m);
  now.velocity = input.uav->velocity_in_world;
  if (!input.target) return now;
  const TurnState& target = input.target->motion;
  const Vector3d from_target = now.feet - target.position();
  now.height_m = from_target.z();
  now.off_m = from_target.head<2>().norm();
  now.slip_mps = (target.velocity() - now.velocity).head<2>().norm();
  now.is_in_sight = input.is_camera_up && input.target_age_s <= options().sight_s;
  now.is_known = input.target->position_sigma_m() <= options().max_sigma_m;
  const double climb_sigma = std::sqrt(std::max(target.covariance(5, 5), 0.0));
  now.is_credible =
      std::abs(target.velocity().z()) <= GuidanceOptions::kMaxTargetClimb_mps + 2 * climb_sigma;
  return now;
}

bool DescentGuidance::MayDescend(const Situation& now) const {
  return now.is_known && now.is_credible && now.is_in_sight && now.slip_mps < kMaxClosing_mps;
}

double DescentGuidance::Cone(double height_m) const {
  return options().cone_m + GuidanceOptions::kConeSlope * std::max(height_m, 0.0);
}

bool DescentGuidance::IsBehind(const GuidanceInput& input) const {
  const Situation now = Look(input);
  return now.off_m > 2 * Cone(now.height_m) || now.slip_mps > 2 * kMaxClosing_mps;
}

void DescentGuidance::StartSearch() {
  road_.Reset();
  search_.Start(place());
  Enter(GuidancePhase::kSearch, "the pilot has given the mode");
}

void DescentGuidance::SearchAfterLoss(Time now) {
  search_.StartAfterLoss(now, road_, place());
  pursuit().Reset();
  Enter(GuidancePhase::kSearch, search_.step());
}

SetPoint DescentGuidance::Search(const GuidanceInput& input, const Situation& now) {
  const double seconds = SecondsSinceLast(input.now);
  const Vector2d place = search_.Advance(input.now, road_, now.feet.head<2>(), seconds);
  if (*search_.step() != '\0') set_reason(search_.step());
  SetPoint command = pursuit().To(place, {now.feet.head<2>(), now.velocity.head<2>()},
                                  &flight_model(), options().limits.max_speed_mps);
  command.velocity.z() = kHeightGain * (options().search_altitude_m - now.feet.z());
  return command;
}

void DescentGuidance::KeepPlace(const GuidanceInput& input, const Situation& now) {
  const TurnState& target = input.target->motion;
  set_place(target.position().head<2>());
  if (now.is_in_sight) {
    road_.Add(input.now, place(), target.velocity().head<2>(), target.turn_rate());
  }
}

}  // namespace kestrel
