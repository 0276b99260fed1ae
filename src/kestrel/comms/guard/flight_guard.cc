// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/guard/flight_guard.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace kestrel {
namespace {

constexpr Duration kSetPointPeriod = std::chrono::milliseconds(20);
constexpr Duration kRequestPeriod = std::chrono::milliseconds(300);
// Shorter than the shortest time after which PX4 takes a stream of set-points for broken off.
constexpr Duration kPause = std::chrono::milliseconds(250);
// PX4's Hold and ArduCopter's BRAKE brake more softly than a set-point, and BRAKE lets a UAV that
// sinks sink on for seconds: they are requested once the UAV stands, or after this time.
constexpr Duration kLongestStop = std::chrono::seconds(3);
constexpr double kStands_mps = 0.4;
constexpr Duration kVelocityAge = std::chrono::milliseconds(300);  // an older one is not used
constexpr Duration kThrottleAge = std::chrono::seconds(2);
// ArduCopter shapes a wanted velocity gently (2.5 m/s^2, 1 m/s^2 down), and adds a wanted
// acceleration within its limits of jerk (PSC_JERK_NE and _D as they come): a braking that ends
// faster than they allow would carry it backwards.
constexpr double kJerk = 5;                                 // m/s^3
constexpr double kMaxBraking = 3, kMaxVerticalBraking = 2;  // m/s^2
constexpr Duration kListening = std::chrono::seconds(1);
// An autopilot that is silent for so long is gone.
constexpr Duration kSilence = std::chrono::seconds(10);

const char* TakeOverText(GuardTask task, AutopilotKind kind, bool has_ended, bool has_pilot) {
  if (task == GuardTask::kLower && has_pilot) {
    return has_ended ? "Kestrel is gone, no position: fly by hand"
                     : "Kestrel hangs, no position: fly by hand";
  }
  if (task == GuardTask::kLower) {
    return has_ended ? "Kestrel is gone, no position: LAND" : "Kestrel hangs, no position: LAND";
  }
  if (task == GuardTask::kLand) {
    return has_ended ? "Kestrel is gone, at the deck: LAND" : "Kestrel hangs, at the deck: LAND";
  }
  if (kind == AutopilotKind::kPx4) {
    return has_ended ? "Kestrel is gone: stopping, then Hold"
                     : "Kestrel hangs: stopping, then Hold";
  }
  return has_ended ? "Kestrel is gone: stopping, then BRAKE"
                   : "Kestrel hangs: stopping, then BRAKE";
}

// Takes 'velocity' and its change 'acceleration' on towards rest by one set-point.
template <class Vector>
void Brake(double max_braking, Vector&& velocity, Vector&& acceleration) {
  const double seconds = ToSeconds(kSetPointPeriod);
  const double speed = velocity.norm();
  const double braking =
      std::min({acceleration.norm() + kJerk * seconds, max_braking, std::sqrt(2 * kJerk * speed)});
  if (speed <= braking * seconds) {
    velocity.setZero();
    acceleration.setZero();
    return;
  }
  acceleration = -braking / speed * velocity;
  velocity += seconds * acceleration;
}

}  // namespace

void FlightGuard::TakeLife(GuardTask task, AutopilotKind kind, Time sent) {
  if (state_ != State::kWatches) return;
  task_ = task;
  kind_ = kind;
  life_ = sent;
}

void FlightGuard::TakeMode(bool is_guided, Time now) {
  is_guided_ = is_guided;
  mode_reported_ = now;
}

void FlightGuard::TakeVelocity(const Eigen::Vector3d& velocity, Time now) {
  if (!velocity.allFinite()) return;
  velocity_ = velocity;
  velocity_reported_ = now;
}

std::optional<Eigen::Vector3d> FlightGuard::Velocity(Time now) const {
  if (!velocity_reported_ || now - *velocity_reported_ > kVelocityAge) return std::nullopt;
  return velocity_;
}

// The heading is kept. PX4 stops by itself as fast.
SetPoint FlightGuard::Stop(Time now) {
  if (kind_ == AutopilotKind::kPx4) return {};
  if (!stop_) {
    const auto velocity = Velocity(now);
    if (!velocity) return {};
    stop_ = SetPoint{*velocity};
  }
  Brake(kMaxBraking, stop_->velocity.head<2>(), stop_->acceleration.head<2>());
  Brake(kMaxVerticalBraking, stop_->velocity.tail<1>(), stop_->acceleration.tail<1>());
  return *stop_;
}

// It sends one level attitude only.
void FlightGuard::TakeHeading(float heading) {
  if (state_ == State::kWatches && std::isfinite(heading)) heading_ = heading;
}

void FlightGuard::TakeThrottle(bool is_centred, Time now) {
  if (is_centred) {
    throttle_centred_ = now;
  } else {
    throttle_centred_.reset();
  }
}

// A throttle at its lower end would let the UAV down fast in the pilot's mode.
bool FlightGuard::HasPilot(Time now) const {
  return is_received_ && throttle_centred_ && now - *throttle_centred_ < kThrottleAge;
}

void FlightGuard::TakeRefusal() {
  if (state_ == State::kWorks) is_refused_ = !is_refused_;
}

GuardAction FlightGuard::Update(Time now) {
  switch (state_) {
    case State::kWatches:
      if (task_ == GuardTask::kNothing || !is_armed_) {
        if (has_ended_) state_ = State::kDone;
        return {};
      }
      if (has_ended_ || now - life_ > patience_) return TakeOver(now);
      return {};
    case State::kWorks:
      return Work(now);
    case State::kListens:
      if (now - since_ > kListening) state_ = State::kDone;
      return {};
    case State::kDone:
      return {};
  }
  return {};
}

// The mode may have been left before: then nothing is sent to the autopilot but words.
GuardAction FlightGuard::TakeOver(Time now) {
  has_taken_over_ = true;
  since_ = now;
  mode_reported_ = std::max(mode_reported_, life_);
  if (!is_guided_) return HandBack("Kestrel is gone, the mode was left before", now);
  state_ = State::kWorks;
  GuardAction action = Work(now);
  action.text = TakeOverText(task_, kind_, has_ended_, HasPilot(now));
  return action;
}

GuardAction FlightGuard::Work(Time now) {
  if (!is_armed_) return HandBack("Kestrel's guard: the motors are off", now);
  if (!is_guided_) return HandBack("Kestrel's guard has handed back: take over", now);
  if (now - mode_reported_ > kSilence)
    return HandBack("Kestrel's guard: the autopilot is silent", now);
  GuardAction action;
  if (task_ == GuardTask::kStop && now >= set_point_due_) {
    set_point_due_ = now + kSetPointPeriod;
    action.stop = Stop(now);
  }
  if (task_ == GuardTask::kLower && kind_ == AutopilotKind::kArduPilot) {
    action.level = std::exchange(heading_, std::nullopt);
  }
  if (now < mode_due_) return action;
  action.mode = ModeToRequest(now);
  if (!action.mode) return action;
  mode_due_ = now + kRequestPeriod;
  // PX4 reports its mode late, and must not get a set-point once it has left OFFBOARD.
  if (kind_ == AutopilotKind::kPx4) set_point_due_ = now + kPause;
  return action;
}

std::optional<FlightMode> FlightGuard::ModeToRequest(Time now) const {
  if (task_ == GuardTask::kLand) return FlightMode::kLand;
  if (task_ == GuardTask::kLower) {
    return HasPilot(now) && !is_refused_ ? FlightMode::kAltitude : FlightMode::kLand;
  }
  const auto velocity = Velocity(now);
  const bool is_led = stop_ && !stop_->velocity.isZero();
  const bool is_stopped = velocity && velocity->norm() < kStands_mps && !is_led;
  if (!is_stopped && now - since_ < kLongestStop) return std::nullopt;
  return kind_ != AutopilotKind::kPx4 && is_refused_ ? FlightMode::kPilot : FlightMode::kHold;
}

GuardAction FlightGuard::HandBack(const char* text, Time now) {
  state_ = State::kListens;
  since_ = now;
  GuardAction action;
  action.text = text;
  return action;
}

}  // namespace kestrel
