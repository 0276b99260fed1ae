// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/carried_proof.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFlown_s = 20;

// Proof after 20 s of a motion by time, s.
double Proof(const std::function<CarriedProof::Motion(double)>& motion) {
  constexpr double kStep_s = 0.02;
  CarriedProof proof;
  for (double time_s = 0; time_s < kFlown_s; time_s += kStep_s) {
    proof.Observe(Time(DurationFromSeconds(time_s)), motion(time_s));
  }
  return proof.seconds();
}

// Acceleration of a curve at 8.3 m/s with a radius of 26 m.
Vector2d InCurve(double time_s) {
  return 2.7 * Vector2d(std::cos(0.32 * time_s), std::sin(0.32 * time_s));
}

Vector3d LeanFor(const Vector2d& acceleration) {
  return Vector3d(acceleration.x(), acceleration.y(), kGravity).normalized();
}

TEST(CarriedProofTest, TurningDeckUnderLevelUavIsProof) {
  const double seconds = Proof([](double time_s) {
    return CarriedProof::Motion{Vector3d::UnitZ(), InCurve(time_s), 0};
  });
  EXPECT_NEAR(seconds, kFlown_s, 0.1);
}

TEST(CarriedProofTest, HeavingDeckIsProofWhileItRises) {
  const double seconds = Proof([](double time_s) {
    return CarriedProof::Motion{Vector3d::UnitZ(), {0, 0}, 0.52 * std::cos(2 * M_PI * time_s / 6)};
  });
  EXPECT_GT(seconds, 5);
  EXPECT_LT(seconds, kFlown_s / 2);
}

TEST(CarriedProofTest, FlightIsNoProof) {
  const auto curve = [](double time_s) {  // in a cross wind that takes a lean of its own
    const Vector2d by_lean = InCurve(time_s) + Vector2d(0, 1.5);
    return CarriedProof::Motion{LeanFor(by_lean), InCurve(time_s), -0.5};
  };
  EXPECT_EQ(Proof(curve), 0);
  const auto hover = [](double) { return CarriedProof::Motion{LeanFor({3, 0}), {0.3, 0}, 0.12}; };
  EXPECT_EQ(Proof(hover), 0);
}

// A gust of 1 s pushes at first, then the UAV leans against it.
TEST(CarriedProofTest, GustsAreLittleProof) {
  const double seconds = Proof([](double time_s) {
    const bool pushes = std::fmod(time_s, 10) < 0.5;
    return CarriedProof::Motion{Vector3d::UnitZ(), {pushes ? 1.5 : 0, 0}, 0};
  });
  EXPECT_LT(seconds, 1.1);
}

TEST(CarriedProofTest, GapInTimeIsNoProof) {
  CarriedProof proof;
  const CarriedProof::Motion motion{Vector3d::UnitZ(), {3, 0}, 0};
  proof.Observe(Time(DurationFromSeconds(0)), motion);
  proof.Observe(Time(DurationFromSeconds(9)), motion);
  EXPECT_LE(proof.seconds(), 0.2);
  proof.Reset();
  EXPECT_EQ(proof.seconds(), 0);
}

}  // namespace
}  // namespace kestrel
