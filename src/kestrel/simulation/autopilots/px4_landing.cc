// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/px4_landing.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kestrel {
namespace {

using Eigen::Vector2d;

// PX4 smooths the set-points of a mission; with MPC_XY_P this trails a moving target by 2 s in all,
// as measured.
constexpr double kSmoothing_s = 0.95;
constexpr double kAcceleration = 3;
// Time that it waits before it searches, and above the target before it descends.
constexpr double kPatience_s = 2;

}  // namespace

Px4Landing::Px4Landing(const AutopilotParameters& parameters, const Px4TimeSync& clock,
                       Announce announce)
    : parameters_(parameters), target_(parameters, clock, std::move(announce)) {}

void Px4Landing::StartLanding(const FlightState& state) {
  goal_ = state.position().head<2>();
  set_point_ = goal_;
  altitude_ = state.position().z();
  searches_ = 0;
  Enter(Phase::kStart, state);
}

void Px4Landing::Enter(Phase phase, const FlightState& state) {
  phase_ = phase;
  phase_s_ = 0;
  above_s_ = 0;
  if (phase == Phase::kStart) goal_ = state.position().head<2>();
  if (phase == Phase::kSearch) {
    ++searches_;
    altitude_ = std::max(parameters_["PLD_SRCH_ALT"], state.position().z());
  }
}

SetPoint Px4Landing::Land(const FlightState& state) {
  ObserveTarget(state);
  phase_s_ += state.step_s;
  ChoosePhase(state);
  set_point_ += std::min(state.step_s / kSmoothing_s, 1.0) * (goal_ - set_point_);
  SetPoint command;
  Vector2d horizontal =
      BrakingVelocity(set_point_ - state.position().head<2>(), parameters_["MPC_XY_P"],
                      kAcceleration, parameters_["MPC_XY_CRUISE"]);
  const bool follows = phase_ == Phase::kApproach || phase_ == Phase::kDescend;
  if (follows && target_.place()) {
    // The estimator's velocity moves the set-point along.
    horizontal += target_.place()->velocity;
    set_point_ += state.step_s * target_.place()->velocity;
  }
  command.velocity << horizontal, ClimbRate(state);
  return command;
}

void Px4Landing::ObserveTarget(const FlightState& state) {
  is_updated_ = target_.TakeUpdated();
  is_valid_ = is_valid_ || is_updated_;
  if (!target_.place() || std::abs(AgeOfTarget(state)) > parameters_["PLD_BTOUT"]) {
    is_valid_ = false;
  }
}

// Age in seconds, by its stamp: negative when that is in the future.
double Px4Landing::AgeOfTarget(const FlightState& state) const {
  return 1e-6 *
         (static_cast<double>(state.boot_us) - static_cast<double>(target_.place()->stamp_us));
}

bool Px4Landing::IsAbove(const FlightState& state) const {
  const double radius = parameters_["PLD_HACC_RAD"];
  const Vector2d error = target_.place()->in_world.head<2>() - state.position().head<2>();
  return std::abs(error.x()) < radius && std::abs(error.y()) < radius;
}

bool Px4Landing::CanApproach(const FlightState& state) const {
  if (phase_ != Phase::kApproach) return is_updated_;
  // Above the place where it last saw the target, it needs to see it again; on the way there it
  // does not.
  return is_valid_ || !IsAbove(state);
}

bool Px4Landing::IsNearGround(const FlightState& state) const {
  return is_valid_ &&
         state.position().z() - target_.place()->in_world.z() < parameters_["PLD_FAPPR_ALT"];
}

bool Px4Landing::CanDescend(const FlightState& state) const {
  constexpr double kCriticalAge_s = 0.5;
  if (phase_ != Phase::kDescend) return is_updated_ && IsAbove(state);
  if (IsNearGround(state)) return AgeOfTarget(state) < kCriticalAge_s;
  return is_valid_;
}

void Px4Landing::ChoosePhase(const FlightState& state) {
  switch (phase_) {
    case Phase::kStart:
      if (CanApproach(state)) {
        altitude_ = state.position().z();
        Enter(Phase::kApproach, state);
      } else if (phase_s_ > kPatience_s) {
        const bool may_search =
            parameters_["PLD_SRCH_TOUT"] > 0 && searches_ < parameters_["PLD_MAX_SRCH"];
        Enter(may_search ? Phase::kSearch : Phase::kFallback, state);
      }
      return;
    case Phase::kApproach:
      return Approach(state);
    case Phase::kDescend:
      return Descend(state);
    case Phase::kSearch:
      return Search(state);
    case Phase::kFinal:
    case Phase::kFallback:
      return;
  }
}

void Px4Landing::Approach(const FlightState& state) {
  if (!CanApproach(state)) return Enter(Phase::kStart, state);
  if (CanDescend(state) && above_s_ == 0) above_s_ = state.step_s;
  // Once it was above the target, the time runs on; at the end it has to be there again.
  if (above_s_ > 0) above_s_ += state.step_s;
  if (above_s_ > kPatience_s && CanDescend(state)) return Enter(Phase::kDescend, state);
  goal_ = target_.place()->in_world.head<2>();
}

void Px4Landing::Descend(const FlightState& state) {
  if (!CanDescend(state)) {
    return Enter(IsNearGround(state) ? Phase::kFinal : Phase::kStart, state);
  }
  goal_ = target_.place()->in_world.head<2>();
}

void Px4Landing::Search(const FlightState& state) {
  constexpr double kSettled_s = 1;
  if (is_updated_ && above_s_ == 0) {
    above_s_ = state.step_s;
    altitude_ = std::min(altitude_, state.position().z() + 1);
  }
  if (above_s_ > 0) above_s_ += state.step_s;
  if (above_s_ > kSettled_s && CanApproach(state)) return Enter(Phase::kApproach, state);
  if (phase_s_ > parameters_["PLD_SRCH_TOUT"]) Enter(Phase::kFallback, state);
}

bool Px4Landing::Sinks() const {
  return phase_ == Phase::kDescend || phase_ == Phase::kFinal || phase_ == Phase::kFallback;
}

double Px4Landing::ClimbRate(const FlightState& state) const {
  if (!Sinks()) {
    constexpr double kGain = 1;
    return std::clamp(kGain * (altitude_ - state.position().z()), -parameters_["MPC_Z_V_AUTO_DN"],
                      parameters_["MPC_Z_VEL_MAX_UP"]);
  }
  const double high = parameters_["MPC_LAND_ALT1"];
  const double low = parameters_["MPC_LAND_ALT2"];
  const double part = std::clamp((state.position().z() - low) / (high - low), 0.0, 1.0);
  return -std::lerp(parameters_["MPC_LAND_SPEED"], parameters_["MPC_Z_V_AUTO_DN"], part);
}

}  // namespace kestrel
