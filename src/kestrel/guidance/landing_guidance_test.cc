// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/guidance/landing_guidance.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/flight/multicopter.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kControlStep_s = 0.01;
constexpr double kBoard_m = 1.8;  // height

// A target on a circle of 8 m at 4.2 m/s, known to 'sigma_m'.
TargetEstimate OnCircle(double time_s, double sigma_m = 0.03) {
  constexpr double kRadius_m = 8;
  constexpr double kRate = 4.2 / kRadius_m;
  const double angle = kRate * time_s;
  TargetEstimate target;
  target.time = TimeFromNanoseconds(0) + DurationFromSeconds(time_s);
  target.motion.mean.head<3>() << kRadius_m * std::cos(angle), kRadius_m * std::sin(angle),
      kBoard_m;
  target.motion.mean.segment<3>(3) << -4.2 * std::sin(angle), 4.2 * std::cos(angle), 0;
  target.motion.mean(6) = kRate;
  target.motion.covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m);
  return target;
}

// Guidance and multicopter, both of which know everything.
struct Flight {
  Flight() : multicopter({}, {-12, 0, 10}, 0), guidance({}, Vector2d(8, 0)) {}

  // Flies on; 'target' gives the target at a time, or nothing.
  template <class Target>
  void FlyUntil(double end_s, const Target& target) {
    for (; time_s < end_s && Height() > 0; time_s += kControlStep_s) {
      const UavState uav{multicopter.position(), multicopter.velocity()};
      multicopter.Step(guidance.Command(uav, target(time_s)), {3, 2, 0}, kControlStep_s);
    }
  }
  double Height() const { return multicopter.position().z() - kBoard_m; }

  Multicopter multicopter;
  LandingGuidance guidance;
  double time_s = 0;
};

const auto kKnown = [](double time_s) { return std::optional(OnCircle(time_s)); };
const auto kUnknown = [](double) { return std::optional<TargetEstimate>(); };

TEST(LandingGuidanceTest, ComesDownOnATargetThatTurns) {
  Flight flight;
  flight.FlyUntil(30, kKnown);
  EXPECT_LT(flight.time_s, 15);
  EXPECT_EQ(flight.guidance.phase(), LandingPhase::kCommit);
  EXPECT_EQ(flight.guidance.go_arounds(), 0);
  const TargetEstimate target = OnCircle(flight.time_s);
  const Vector3d offset = flight.multicopter.position() - target.motion.position();
  const Vector3d slip = flight.multicopter.velocity() - target.motion.velocity();
  EXPECT_LT(offset.head<2>().norm(), 0.08);
  EXPECT_LT(slip.head<2>().norm(), 0.2);
  EXPECT_NEAR(-slip.z(), 0.7, 0.15);
}

TEST(LandingGuidanceTest, WaitsWhereTheVehicleShouldPass) {
  Flight flight;
  flight.FlyUntil(12, kUnknown);
  EXPECT_EQ(flight.guidance.phase(), LandingPhase::kSearch);
  EXPECT_LT((flight.multicopter.position() - Vector3d(8, 0, 10)).norm(), 0.3);
}

TEST(LandingGuidanceTest, ClimbsAndSearchesWhenTheTargetIsLost) {
  Flight flight;
  while (flight.Height() > 1) flight.FlyUntil(flight.time_s + kControlStep_s, kKnown);
  EXPECT_EQ(flight.guidance.phase(), LandingPhase::kDescend);
  const Vector3d last = OnCircle(flight.time_s).motion.position();
  flight.FlyUntil(flight.time_s + 12, kUnknown);
  EXPECT_EQ(flight.guidance.go_arounds(), 1);
  EXPECT_EQ(flight.guidance.phase(), LandingPhase::kSearch);
  EXPECT_LT((flight.multicopter.position().head<2>() - last.head<2>()).norm(), 0.5);
  EXPECT_NEAR(flight.multicopter.position().z(), 10, 0.3);
}

TEST(LandingGuidanceTest, DoesNotGoDownOnWhatItHardlyKnows) {
  Flight flight;
  flight.FlyUntil(20, [](double time_s) { return std::optional(OnCircle(time_s, 0.4)); });
  EXPECT_EQ(flight.guidance.phase(), LandingPhase::kApproach);
  EXPECT_NEAR(flight.Height(), 2.5, 0.3) << "follows";
  flight.FlyUntil(40, [](double time_s) { return std::optional(OnCircle(time_s, 0.8)); });
  EXPECT_NEAR(flight.multicopter.position().z(), 10, 0.3) << "climbs";
}

}  // namespace
}  // namespace kestrel
