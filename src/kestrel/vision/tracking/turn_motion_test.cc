// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tracking/turn_motion.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

constexpr SwayMotion kNoSway = {0, 1, 0.5};
constexpr TurnNoise kNoNoise = {0, 0, 0, 1e12, kNoSway};

TurnState State(const Eigen::Vector3d& velocity, double turn_rate) {
  TurnState state;
  state.mean.segment<3>(3) = velocity;
  state.mean(6) = turn_rate;
  state.covariance.setIdentity();
  return state;
}

TEST(Propagate, FollowsCircle) {
  const double turn_rate = 0.5;
  const double radius = 8;
  const TurnState later = Propagate(State({0, radius * turn_rate, 0.1}, turn_rate), 2, kNoNoise);
  const double angle = turn_rate * 2;
  EXPECT_NEAR(later.mean(0), radius * (std::cos(angle) - 1), 1e-9);
  EXPECT_NEAR(later.mean(1), radius * std::sin(angle), 1e-9);
  EXPECT_NEAR(later.mean(2), 0.2, 1e-9);
  EXPECT_NEAR(later.mean(3), -radius * turn_rate * std::sin(angle), 1e-9);
  EXPECT_NEAR(later.mean(4), radius * turn_rate * std::cos(angle), 1e-9);
}

TEST(Propagate, ChangeOfTurnRateDecays) {
  TurnState state = State({4, 0, 0}, 0);
  state.mean(7) = 0.5;
  const TurnState later = Propagate(state, 1, {0, 0, 0, 1, kNoSway});
  EXPECT_NEAR(later.turn_rate(), 0.5 * (1 - std::exp(-1.0)), 0.01);
  EXPECT_NEAR(later.mean(7), 0.5 * std::exp(-1.0), 1e-9);
  EXPECT_NEAR(later.velocity().norm(), 4, 1e-9);
  EXPECT_GT(later.mean(1), 0.2);  // to the left
}

TEST(Propagate, CovarianceMatchesNumericalJacobian) {
  constexpr double kDelta = 1e-5;
  TurnState state = State({3, 2, 0}, 0.6);
  state.mean.tail<6>() << 0.3, 0.02, -0.01, 0.1, 0.2, 1.2;
  TurnState moved = state;
  const TurnState later = Propagate(state, 0.05, kNoNoise);
  Eigen::Matrix<double, kTurnStateSize, kTurnStateSize> jacobian;
  for (int i = 0; i < kTurnStateSize; ++i) {
    moved.mean = state.mean;
    moved.mean(i) += kDelta;
    jacobian.col(i) = (Propagate(moved, 0.05, kNoNoise).mean - later.mean) / kDelta;
  }
  EXPECT_LT((later.covariance - jacobian * jacobian.transpose()).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Propagate, SwayOscillatesOnVehicle) {
  TurnState state = State({4, 0, 0}, 0);
  state.mean(1) = 0.05;  // y, all of it sway
  state.mean(9) = 0.05;
  TurnNoise noise = kNoNoise;
  noise.sway = {0.05, 2, 0.01};
  const TurnState half_a_period = Propagate(state, 0.25, noise);
  EXPECT_NEAR(half_a_period.mean(0), 1, 1e-9);
  EXPECT_NEAR(half_a_period.mean(1), -0.05, 0.003);
  EXPECT_NEAR(half_a_period.mean(9), -0.05, 0.003);
  EXPECT_NEAR(half_a_period.velocity().y(), 0, 0.05);
}

TEST(Propagate, SwayVarianceIsStationary) {
  TurnNoise noise = kNoNoise;
  noise.sway = {0.02, 1.4, 0.3};
  const TurnState start =
      StartState({0, 0, 0}, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero(), 0, noise);
  EXPECT_NEAR(start.covariance(8, 8), 0.0004, 1e-12);
  const TurnState later = Propagate(start, 3, noise);
  EXPECT_NEAR(later.covariance(8, 8), 0.0004, 1e-9);
  EXPECT_NEAR(later.covariance(10, 10), start.covariance(10, 10), 1e-9);
  EXPECT_NEAR(later.covariance(3, 3), start.covariance(3, 3), 1e-9);
}

TEST(Propagate, LoadTurnsWithVehicle) {
  TurnState state = State({4, 0, 0}, 0.5);
  state.mean(12) = 0.2;
  EXPECT_NEAR(Propagate(state, 2, kNoNoise).mean(12), 1.2, 1e-9);
}

TEST(Propagate, ZeroTimeChangesNothing) {
  const TurnState state = State({3, 2, 0}, 0.6);
  EXPECT_EQ(Propagate(state, 0, {1, 1, 1, 1, kNoSway}).mean, state.mean);
}

TEST(Propagate, UncertaintyGrows) {
  const TurnState state = State({3, 0, 0}, 0.6);
  const TurnState later = Propagate(state, 1, {1, 1, 0.1, 2, kNoSway});
  EXPECT_GT(later.covariance(0, 0), state.covariance(0, 0));
  EXPECT_GT(later.covariance(6, 6), state.covariance(6, 6));
}

TEST(UpdateByPosition, WeightsBothByCovariance) {
  TurnState state = State({0, 0, 0}, 0);
  state.covariance.setIdentity();
  const TurnState updated = UpdateByPosition(state, {1, 2, 3}, 3 * Eigen::Matrix3d::Identity());
  EXPECT_LT((updated.position() - Eigen::Vector3d(0.25, 0.5, 0.75)).norm(), 1e-12);
  EXPECT_NEAR(updated.covariance(0, 0), 0.75, 1e-12);
  EXPECT_NEAR(updated.covariance(6, 6), 1, 1e-12);
}

TEST(UpdateByYaw, AcceptsYawUpToSymmetryOfPad) {
  TurnState state = State({0, 0, 0}, 0);
  state.covariance *= 0.01;
  const double quarter = std::numbers::pi / 2;
  EXPECT_NEAR(UpdateByYaw(state, 3 * quarter + 0.1, 0.01, quarter, 16).mean(12), 0.05, 1e-12);
  EXPECT_NEAR(UpdateByYaw(state, 0.1 - quarter, 0.01, quarter, 16).covariance(12, 12), 0.005,
              1e-12);
  EXPECT_NEAR(UpdateByYaw(state, 4 * quarter - 0.1, 0.01, 4 * quarter, 16).mean(12), -0.05, 1e-12);
}

TEST(UpdateByYaw, ChangesNothingBeyondGate) {
  TurnState state = State({0, 0, 0}, 0);
  state.covariance *= 1e-4;
  EXPECT_EQ(UpdateByYaw(state, 0.5, 1e-4, std::numbers::pi / 2, 16).mean, state.mean);
}

TEST(SquaredDistance, UsesBothCovariances) {
  const TurnState state = State({0, 0, 0}, 0);
  EXPECT_NEAR(SquaredDistance(state, {2, 0, 0}, 3 * Eigen::Matrix3d::Identity()), 1, 1e-12);
}

}  // namespace
}  // namespace kestrel
