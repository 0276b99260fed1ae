// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "kestrel/core/poses/gravity.h"
#include "kestrel/flight/guidance/landing_guidance.h"
#include "kestrel/simulation/scene/vehicle_motion.h"
#include "kestrel/simulation/vehicle/multicopter_motion.h"
#include "kestrel/simulation/vehicle/wind.h"

namespace kestrel {

inline constexpr double kTestStep_s = 0.02;  // step of guidance, 50 Hz
inline constexpr double kTestBoard_m = 1.8;  // height of the deck

// A multicopter whose autopilot controls the velocity as ArduCopter and PX4 do.
struct TestUavOptions {
  double p = 4;
  double i = 0;
  bool compensates_drag = false;
  double attitude_lag_s = 0.06;  // time constant of each of two lags
  double drag = 0.25;
  double max_tilt_deg = 40;
  double shaping_accel = 0;  // limit of the commands' shaping, m/s^2; 0: none
  double shaping_jerk = 0;
  double delay_s = 0;  // delay of the link

  static TestUavOptions Px4() {
    return {.p = 1.8, .i = 0.4, .attitude_lag_s = 0.08, .drag = 0.2, .max_tilt_deg = 45};
  }
  // The control law as guidance reads it from the parameters.
  VelocityControl Control() const {
    return shaping_accel > 0 ? VelocityControl() : VelocityControl{p, i, 0};
  }
  static TestUavOptions ArduCopter() {
    return {.p = 2,
            .i = 1,
            .attitude_lag_s = 0.08,
            .drag = 0.15,
            .max_tilt_deg = 30,
            .shaping_accel = 2.5,
            .shaping_jerk = 5};
  }
};

class TestUav {
 public:
  TestUav(const TestUavOptions& options, const Eigen::Vector3d& position)
      : options_(options), position_(position) {}

  void Step(const std::optional<SetPoint>& sent, const Eigen::Vector3d& wind) {
    if (sent) pipe_.push_back(*sent);
    const auto late = static_cast<std::size_t>(std::lround(options_.delay_s / kTestStep_s));
    for (; pipe_.size() > late; pipe_.pop_front()) command_ = pipe_.front();
    if (!sent) command_ = SetPoint();
    constexpr int kSubsteps = 4;
    for (int i = 0; i < kSubsteps; ++i) SubStep(wind, kTestStep_s / kSubsteps);
  }

  UavState State() const {
    return {{MulticopterAttitude(thrust_, 0), position_}, velocity_, std::nullopt};
  }
  const Eigen::Vector3d& position() const { return position_; }
  const Eigen::Vector3d& velocity() const { return velocity_; }

 private:
  // Input shaping: the shaped velocity reaches the commanded one with limited acceleration and
  // jerk.
  void Shape(double seconds) {
    if (options_.shaping_accel <= 0) {
      shaped_ = command_;
      return;
    }
    const double gain = options_.shaping_jerk / options_.shaping_accel;
    Eigen::Vector3d wanted = gain * (command_.velocity - shaped_.velocity) + command_.acceleration;
    const double size = wanted.head<2>().norm();
    if (size > options_.shaping_accel) wanted.head<2>() *= options_.shaping_accel / size;
    Eigen::Vector3d change = wanted - shaped_.acceleration;
    const double most = options_.shaping_jerk * seconds;
    if (change.head<2>().norm() > most) change.head<2>() *= most / change.head<2>().norm();
    change.z() = std::clamp(change.z(), -2 * most, 2 * most);
    shaped_.acceleration += change;
    shaped_.velocity += seconds * shaped_.acceleration;
  }

  void SubStep(const Eigen::Vector3d& wind, double seconds) {
    Shape(seconds);
    const Eigen::Vector3d error = shaped_.velocity - velocity_;
    integral_ += seconds * options_.i * error;
    Eigen::Vector3d wanted = shaped_.acceleration + options_.p * error + integral_;
    wanted.z() = std::clamp(shaped_.acceleration.z() + 4 * error.z(), -5.0, 5.0);
    const Eigen::Vector3d drag = options_.drag * (wind - velocity_);
    if (options_.compensates_drag) wanted -= drag;
    const double most = std::tan(options_.max_tilt_deg * EIGEN_PI / 180) * (kGravity + wanted.z());
    const double size = wanted.head<2>().norm();
    if (size > most) {
      wanted.head<2>() *= most / size;
      integral_.head<2>() -= seconds * options_.i * error.head<2>();
    }
    const double lag = 1 - std::exp(-seconds / options_.attitude_lag_s);
    lagging_ += lag * (wanted + kGravity * Eigen::Vector3d::UnitZ() - lagging_);
    thrust_ += lag * (lagging_ - thrust_);
    const Eigen::Vector3d acceleration = thrust_ + drag - kGravity * Eigen::Vector3d::UnitZ();
    position_ += seconds * (velocity_ + 0.5 * seconds * acceleration);
    velocity_ += seconds * acceleration;
  }

  TestUavOptions options_;
  Eigen::Vector3d position_;
  Eigen::Vector3d velocity_{0, 0, 0};
  Eigen::Vector3d thrust_{0, 0, kGravity};
  Eigen::Vector3d lagging_{0, 0, kGravity};
  Eigen::Vector3d integral_{0, 0, 0};
  std::deque<SetPoint> pipe_;
  SetPoint command_;
  SetPoint shaped_;
};

// A driving deck, and the track's estimate of it.
class TestTarget {
 public:
  TestTarget(const VehicleMotionOptions& options, std::uint64_t seed) {
    Random random(seed);
    motion_ = VehicleMotion(options, &random);
    for (auto& wander : wander_) wander = Wander(1, 1.5, &random);
  }

  Eigen::Vector3d Position(double time_s) const {
    return motion_(time_s).translation + kTestBoard_m * Eigen::Vector3d::UnitZ();
  }
  Eigen::Vector3d Velocity(double time_s) const { return VelocityOf(motion_, time_s); }
  Eigen::Vector3d Normal(double time_s) const {
    return motion_(time_s).rotation * Eigen::Vector3d::UnitZ();
  }

  TargetEstimate Estimate(Time time, double time_s, double sigma_m = 0.03) const {
    TargetEstimate target;
    target.time = time;
    target.motion.mean.head<3>() = Position(time_s);
    target.motion.mean.segment<3>(TurnState::kVelocity) = Velocity(time_s);
    target.motion.mean(TurnState::kTurnRate) = TurnRate(time_s);
    target.motion.mean(TurnState::kTurnChange) =
        (TurnRate(time_s + 0.1) - TurnRate(time_s - 0.1)) / 0.2;
    for (int axis = 0; axis < 2; ++axis) {
      target.motion.mean(axis) += 0.02 * wander_[axis](time_s);
      target.motion.mean(3 + axis) += 0.05 * wander_[2 + axis](time_s);
    }
    target.motion.covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m);
    return target;
  }

 private:
  double TurnRate(double time_s) const {
    const Eigen::Vector3d before = Velocity(time_s - 0.05);
    const Eigen::Vector3d after = Velocity(time_s + 0.05);
    const double speed2 = std::max(before.squaredNorm(), 1e-6);
    return (before.x() * after.y() - before.y() * after.x()) / speed2 / 0.1;
  }

  Motion motion_;
  std::function<double(double)> wander_[4];
};

// The steps of a flight, which has Step(change) (see TestFlight), time_s and the newest output.
template <class Flight>
struct FlownInSteps {
  template <class Until>
  bool FlyUntil(const Until& until, double longest_s = 60) {
    return FlyUntil(until, longest_s, [](GuidanceInput&) {});
  }
  template <class Until, class Change>
  bool FlyUntil(const Until& until, double longest_s, const Change& change) {
    auto& flight = static_cast<Flight&>(*this);
    for (const double end_s = flight.time_s + longest_s; flight.time_s < end_s;) {
      flight.Step(change);
      if (until()) return true;
    }
    return false;
  }
  bool FlyUntilPhase(GuidancePhase phase, double longest_s = 60) {
    return FlyUntil([&] { return static_cast<Flight&>(*this).output.phase == phase; }, longest_s);
  }
};

// Guidance, a multicopter, a deck and the wind. Each knows the truth about the others, except for
// what a test takes away.
struct TestFlight : FlownInSteps<TestFlight> {
  explicit TestFlight(const GuidanceOptions& options = {}, const TestUavOptions& uav_options = {},
                      const VehicleMotionOptions& vehicle = {}, std::uint64_t seed = 1)
      : guidance(options), uav(uav_options, {0, 0, 10}), target(vehicle, seed) {
    Random random(seed + 1000);
    wind = MakeWind({}, &random);
  }

  GuidanceInput Input() const {
    GuidanceInput input;
    input.now = TimeFromNanoseconds(0) + DurationFromSeconds(100 + time_s);
    input.uav = uav.State();
    input.target = target.Estimate(input.now, time_s);
    input.target_age_s = 0.05;
    input.deck = DeckSighting{input.now, target.Position(time_s).z(), target.Normal(time_s)};
    input.is_guided = time_s > 0;
    input.is_armed = true;
    if (is_on_deck) {
      const Eigen::Vector3d feet(0.1, 0, 0.35);
      input.uav = UavState{{Eigen::Quaterniond::Identity(), target.Position(time_s) + feet},
                           target.Velocity(time_s),
                           std::nullopt};
    }
    return input;
  }

  // Does one step. 'change' may take something away from the input of guidance.
  template <class Change>
  const GuidanceOutput& Step(const Change& change) {
    GuidanceInput input = Input();
    change(input);
    output = guidance.Update(input);
    uav.Step(output.set_point, wind(time_s));
    time_s += kTestStep_s;
    return output;
  }
  const GuidanceOutput& Step() {
    return Step([](GuidanceInput&) {});
  }

  // Descends and is carried by the deck until guidance has found contact.
  void LandOnDeck() {
    FlyUntil([&] { return Height() <= 0; });
    is_on_deck = true;
    FlyUntilPhase(GuidancePhase::kLanded, 1);
  }

  Eigen::Vector3d Feet() const { return uav.position() - Eigen::Vector3d(0, 0, 0.35); }
  Eigen::Vector3d FromDeck() const { return Feet() - target.Position(time_s); }
  double Height() const { return FromDeck().z(); }
  double Off() const { return FromDeck().head<2>().norm(); }

  LandingGuidance guidance;
  TestUav uav;
  TestTarget target;
  Path wind;
  GuidanceOutput output;
  double time_s = 0;
  bool is_on_deck = false;
};

}  // namespace kestrel
