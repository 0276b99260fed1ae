// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/flight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "kestrel/simulation/scenarios.h"
#include "kestrel/simulation/truth_text.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr double kDeg = 180 / std::numbers::pi;

Vector3d AccelerationOf(const Motion& motion, double time_s) {
  constexpr double kStep_s = 0.01;
  return (VelocityOf(motion, time_s + kStep_s) - VelocityOf(motion, time_s - kStep_s)) /
         (2 * kStep_s);
}

double RateDeg(const Motion& motion, double time_s) {
  constexpr double kStep_s = 0.005;
  return kDeg * motion(time_s).rotation.angularDistance(motion(time_s + kStep_s).rotation) /
         kStep_s;
}

double TiltDeg(const RigidTransform& pose) {
  return kDeg * std::acos((pose.rotation * Vector3d::UnitZ()).z());
}

Motion FlightOf(const char* scenario, std::uint64_t seed) {
  const LandingSimulationOptions options = ReadLandingSimulation(scenario, "", {});
  Random random(seed);
  const Motion vehicle = VehicleMotion(options.vehicle, &random);
  const Path target = [vehicle](double time_s) {
    return Vector3d(vehicle(time_s).translation + 2 * Vector3d::UnitZ());
  };
  return LandingFlight(options.flight, target, options.recording.duration_s(), &random);
}

TEST(FlightTest, CalmFlightAcceleratesLessThanThePapersLimit) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Motion motion = FlightOf("calm", seed);
    for (double time_s = 0.5; time_s < 14.5; time_s += 0.1) {
      ASSERT_LT(AccelerationOf(motion, time_s).norm(), 0.25) << seed << " at " << time_s;
    }
  }
}

TEST(FlightTest, AggressiveFlightTiltsTo40DegreesAndTurnsAt150PerSecond) {
  const Motion motion = FlightOf("aggressive", 1);
  double tilt = 0;
  double rate = 0;
  for (double time_s = 0; time_s < 10; time_s += 0.02) {
    tilt = std::max(tilt, TiltDeg(motion(time_s)));
    rate = std::max(rate, RateDeg(motion, time_s));
  }
  EXPECT_GT(tilt, 35);
  EXPECT_LT(tilt, 50);
  EXPECT_GT(rate, 110);
  EXPECT_LT(rate, 220);
}

TEST(FlightTest, ThrustPointsWhereTheAccelerationIs) {
  Random random(1);
  const Path path = [](double time_s) { return Vector3d(0.5 * 4 * time_s * time_s, 0, 5); };
  const Motion motion = MulticopterMotion(
      path, [](double) { return 0.7; }, 0, &random);
  const RigidTransform pose = motion(1);
  EXPECT_LT(((pose.rotation * Vector3d::UnitZ()) - Vector3d(4, 0, 9.81).normalized()).norm(), 1e-4);
  const Vector3d forward = pose.rotation * Vector3d::UnitX();
  EXPECT_GT(forward.head<2>().normalized().dot(Eigen::Vector2d(std::cos(0.7), std::sin(0.7))),
            0.95);
}

TEST(FlightTest, ApproachEndsWhereItShould) {
  const Motion motion = FlightOf("figure8", 3);
  EXPECT_NEAR(motion(0).translation.z(), 2 + 13, 0.01);
  EXPECT_NEAR(motion(15).translation.z(), 2 + 0.4, 0.01);
}

TEST(FlightTest, VehicleKeepsItsSpeedAndLooksAhead) {
  for (const char* path : {"straight", "circle", "figure8"}) {
    Random random(5);
    VehicleMotionOptions options;
    options.path = path;
    options.speed_mps = 8.3;
    const Motion motion = VehicleMotion(options, &random);
    for (double time_s = 0; time_s < 20; time_s += 0.5) {
      const Vector3d velocity = VelocityOf(motion, time_s);
      ASSERT_NEAR(velocity.norm(), 8.3, 0.4) << path;
      ASSERT_GT((motion(time_s).rotation * Vector3d::UnitX()).dot(velocity.normalized()), 0.999);
    }
  }
}

TEST(FlightTest, WanderHasTheSpreadAskedFor) {
  Random random(4);
  const auto wander = Wander(2, 1, &random);
  double squares = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) squares += std::pow(wander(0.1 * i), 2);
  EXPECT_NEAR(std::sqrt(squares / kSamples), 2, 0.1);
}

TEST(FlightTest, RefusesBadOptionsInWords) {
  LandingFlightOptions flight;
  flight.end_altitude_m = -1;
  EXPECT_EQ(flight.Validate().at(0), "end_altitude_m is -1, expected 0.1 to 100");
  VehicleMotionOptions vehicle;
  vehicle.path = "spiral";
  EXPECT_EQ(vehicle.Validate().at(0),
            "path is 'spiral', expected standing, straight, circle or figure8");
}

}  // namespace
}  // namespace kestrel
