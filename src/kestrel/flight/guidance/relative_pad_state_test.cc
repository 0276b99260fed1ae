// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/relative_pad_state.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using State = RelativePadState;

// A UAV that sways above a pad, where somebody who knows all keeps it, with attitudes at 50 Hz and
// late frames at 16 Hz.
class SwayingFlight {
 public:
  SwayingFlight(State* state, std::uint64_t seed) : state_(*state), random_(seed) {
    bias_ = 0.6 * Vector3d(random_.Normal(), random_.Normal(), 0);
    way_ = {0.5 * random_.Normal(), 0.5 * random_.Normal(), -3};
  }

  void Fly(double seconds) {
    for (const double end_s = s_ + seconds; s_ < end_s; s_ += kStep_s) {
      Move();
      if (++steps_ % 5 == 0) {
        state_.AddAttitude(now(), world_from_body_, rate_);
        if (has_accelerometer) state_.AddAcceleration(now(), Shaken());
        if (knows_velocity) {
          state_.AddOwnVelocity(Eigen::AngleAxisd(compass_, Vector3d::UnitZ()) * -velocity_);
        }
      }
      if (steps_ % 15 != 0) continue;
      if (late_) state_.AddSight(late_time_, late_way_, kNoise_m * kNoise_m * Matrix3d::Identity());
      late_ = is_seen;
      late_time_ = now();
      late_way_ = true_.conjugate() * way_;
      for (double& axis : late_way_) axis += kNoise_m * random_.Normal();
      const double turn = Radians(0.5) * 3;  // of the attitude, at this height
      late_way_ += turn * Vector3d(random_.Normal(), random_.Normal(), 0);
    }
  }
  Time now() const { return TimeFromNanoseconds(std::llround(1e9 * (10 + s_))); }
  // Error of the state in its own variances, both horizontal axes; 8 on average.
  double Nees() const {
    const auto estimate = state_.At(now());
    double sum = 0;
    for (int i = 0; i < 2; ++i) {
      const State::Axis& axis = estimate->axes[static_cast<std::size_t>(i)];
      const Eigen::Vector4d truth(way_(i), velocity_(i), gust_(i), bias_(i));
      const Eigen::Vector4d error = axis.mean - truth;
      sum += error.dot(axis.covariance.ldlt().solve(error));
    }
    return sum;
  }
  Vector3d ErrorOfWay() const { return state_.At(now())->way() - way_; }
  Vector3d way() const { return way_; }
  Vector3d velocity() const { return velocity_; }

  bool is_seen = true;
  bool knows_velocity = false;
  bool has_accelerometer = false;
  double compass_rate = 0;  // rad/s by which its heading turns, and the UAV does not
  double noise = 1;         // of gust and bias

 private:
  static constexpr double kStep_s = 0.004, kNoise_m = 0.01;

  // The gust acts as an acceleration of the pad, the bias as one of the UAV.
  void Move() {
    constexpr double kGusts = 1, kMemory_s = 0.7, kWalk = 0.05;
    const double kept = std::exp(-kStep_s / kMemory_s);
    for (int i = 0; i < 2; ++i) {
      gust_(i) = kept * gust_(i) + noise * kGusts * std::sqrt(1 - kept * kept) * random_.Normal();
      bias_(i) += noise * kWalk * std::sqrt(kStep_s) * random_.Normal();
    }
    const Vector3d sway(1.5 * std::sin(1.3 * s_), 1 * std::cos(0.9 * s_), kGravity);
    const Vector3d thrust = sway + gust_ - bias_ + way_ + 2 * velocity_;
    const Quaterniond before = true_;
    true_ =
        Quaterniond::FromTwoVectors(Vector3d::UnitZ(), Vector3d(thrust.x(), thrust.y(), kGravity));
    rate_ = RotationVector(before.conjugate() * true_) / kStep_s;
    compass_ += compass_rate * kStep_s;
    world_from_body_ = Eigen::AngleAxisd(compass_, Vector3d::UnitZ()) * true_;
    const Vector3d up = true_ * Vector3d::UnitZ();
    Vector3d acceleration = gust_ - bias_ - kGravity / up.z() * up;
    acceleration.z() = 0;
    way_ += kStep_s * (velocity_ + kStep_s / 2 * acceleration);
    velocity_ += kStep_s * acceleration;
    acceleration_ = -acceleration;
  }
  Vector3d Shaken() {
    constexpr double kVibration = 0.3;
    const Vector3d shake(random_.Normal(), random_.Normal(), random_.Normal());
    return true_.conjugate() * (acceleration_ + kGravity * Vector3d::UnitZ()) + kVibration * shake;
  }

  State& state_;
  Random random_;
  double s_ = 0;
  int steps_ = 0;
  Quaterniond true_ = Quaterniond::Identity(), world_from_body_ = Quaterniond::Identity();
  double compass_ = 0;
  Vector3d acceleration_{0, 0, 0};  // of the UAV
  Vector3d rate_{0, 0, 0}, way_{0, 0, 0}, velocity_{0, 0, 0}, gust_{0, 0, 0}, bias_{0, 0, 0};
  bool late_ = false;
  Time late_time_;
  Vector3d late_way_{0, 0, 0};
};

TEST(RelativePadStateTest, CovarianceIsHonest) {
  constexpr int kFlights = 200;
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= kFlights; ++seed) {
    State state(/*pad_moves=*/false);
    SwayingFlight flight(&state, seed);
    flight.Fly(6);
    ASSERT_TRUE(state.At(flight.now()));
    sum += flight.Nees();
  }
  EXPECT_GT(sum / kFlights, 6.5);
  EXPECT_LT(sum / kFlights, 9.5);
}

TEST(RelativePadStateTest, EstimateIsOfNowWhenFramesAreLate) {
  State state(false);
  SwayingFlight flight(&state, 3);
  flight.Fly(8);
  EXPECT_LT(flight.ErrorOfWay().head<2>().norm(), 0.05);
  EXPECT_NEAR(state.At(flight.now())->velocity().x(), flight.velocity().x(), 0.3);
}

TEST(RelativePadStateTest, CoastsByItsBiasWhenPadIsLost) {
  State state(false);
  SwayingFlight flight(&state, 5);
  flight.Fly(20);
  const auto before = state.At(flight.now());
  flight.noise = 0;
  flight.is_seen = false;
  flight.Fly(2);
  const double limit_m = 3 * before->DriftSigma(2);
  EXPECT_LT(flight.ErrorOfWay().head<2>().norm(), limit_m);
  EXPECT_LT(limit_m, 2.5);
}

TEST(RelativePadStateTest, AccelerometerKnowsGustsAsTheyCome) {
  const auto error_of_velocity = [](bool has_accelerometer) {
    double sum = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      State state(false);
      SwayingFlight flight(&state, seed);
      flight.has_accelerometer = has_accelerometer;
      flight.Fly(10);
      const Vector3d error = state.At(flight.now())->velocity() - flight.velocity();
      sum += error.head<2>().squaredNorm();
    }
    return std::sqrt(sum / 20);
  };
  EXPECT_LT(error_of_velocity(true), 0.85 * error_of_velocity(false));
}

TEST(RelativePadStateTest, BiasStaysWhenAccelerometerStops) {
  State state(false);
  SwayingFlight flight(&state, 4);
  flight.noise = 0;
  flight.has_accelerometer = true;
  flight.Fly(10);
  const Vector3d before = state.At(flight.now())->bias();
  flight.has_accelerometer = false;
  flight.Fly(0.5);
  EXPECT_LT((state.At(flight.now())->bias() - before).head<2>().norm(), 0.25);
}

// Of a world that has turned by 80 degrees.
TEST(RelativePadStateTest, OwnVelocityKeepsTheWayWhenPadIsLost) {
  State state(false);
  SwayingFlight flight(&state, 5);
  flight.compass_rate = Radians(20);
  flight.Fly(4);
  flight.compass_rate = 0;
  flight.Fly(16);
  flight.is_seen = false;
  flight.knows_velocity = true;
  flight.Fly(8);
  const auto estimate = state.At(flight.now());
  EXPECT_LT(flight.ErrorOfWay().head<2>().norm(), 0.4);  // metres without it
  EXPECT_LT((estimate->velocity() - flight.velocity()).head<2>().norm(), 0.3);
  EXPECT_LT(estimate->Sigma(State::kVelocity), 0.3);
  EXPECT_LT(estimate->ClimbSigma(), 0.3);
}

TEST(RelativePadStateTest, OwnVelocityDoesNotCountOverPadThatMayMove) {
  State state(/*pad_moves=*/true);
  SwayingFlight flight(&state, 5);
  flight.Fly(10);
  flight.is_seen = false;
  flight.knows_velocity = true;
  flight.Fly(3);
  const auto estimate = state.At(flight.now());
  EXPECT_GT(estimate->Sigma(State::kVelocity), 0.5);
  EXPECT_LT(estimate->ClimbSigma(), 0.4);
}

// The attitude's world turns by 40 degrees: the way to the pad, against the nose, does not.
TEST(RelativePadStateTest, CompassThatTurnsDoesNotTurnWay) {
  State state(false);
  SwayingFlight flight(&state, 7);
  flight.Fly(10);
  flight.compass_rate = Radians(20);
  flight.Fly(2);
  flight.compass_rate = 0;
  flight.Fly(1);
  EXPECT_LT(flight.ErrorOfWay().head<2>().norm(), 0.2);  // 0.5 m if it turned along
}

TEST(RelativePadStateTest, OtherPadIsTakenAfterHalfASecond) {
  State state(false);
  const auto at = [](double s) { return TimeFromNanoseconds(std::llround(1e9 * s)); };
  double s = 10;
  const auto see = [&](double seconds, const Vector3d& pad) {
    bool is_used = false;
    for (const double end = s + seconds; s < end; s += 0.05) {
      state.AddAttitude(at(s), Quaterniond::Identity(), Vector3d::Zero());
      is_used = state.AddSight(at(s), pad, 1e-4 * Matrix3d::Identity());
    }
    return is_used;
  };
  EXPECT_TRUE(see(2, {0, 0, -3}));
  EXPECT_FALSE(see(0.3, {2, 0, -3}));
  EXPECT_TRUE(see(0.5, {2, 0, -3}));
  EXPECT_NEAR(state.At(at(s))->way().x(), 2, 0.05);
}

// As often as the attitude may come: the ring of attitudes is shorter than the loss.
TEST(RelativePadStateTest, AgeOfSightGrowsWithoutPad) {
  State state(false);
  const auto at = [](int i) { return TimeFromNanoseconds(10'000'000'000 + 2'000'000LL * i); };
  state.AddAttitude(at(0), Quaterniond::Identity(), Vector3d::Zero());
  ASSERT_TRUE(state.AddSight(at(0), {0, 0, -3}, 1e-4 * Matrix3d::Identity()));
  for (int i = 1; i <= 5000; ++i) {  // ten seconds
    state.AddAttitude(at(i), Quaterniond::Identity(), Vector3d::Zero());
  }
  EXPECT_EQ(state.sighted(), at(0));
  EXPECT_TRUE(state.At(at(5000)));
  for (int i = 5001; i <= 32000; ++i) {
    state.AddAttitude(at(i), Quaterniond::Identity(), Vector3d::Zero());
  }
  EXPECT_FALSE(state.sighted());  // a minute later it is nowhere
}

TEST(RelativePadStateTest, SightWithoutAttitudeIsNotUsed) {
  State state(false);
  EXPECT_FALSE(state.AddSight(TimeFromNanoseconds(1), {0, 0, -3}, Matrix3d::Identity()));
  EXPECT_FALSE(state.At(TimeFromNanoseconds(2)));
}

}  // namespace
}  // namespace kestrel
