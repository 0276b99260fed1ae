// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/scenarios.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/options.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/scene/vehicle_motion.h"
#include "kestrel/simulation/vehicle/landing_flight.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

TEST(ScenariosTest, AllScenariosAreValid) {
  for (const Scenario& scenario : LandingScenarios()) {
    EXPECT_NO_THROW(ReadLandingSimulation(scenario.name, "", {})) << scenario.name;
  }
  for (const Scenario& scenario : HuntScenarios()) {
    EXPECT_NO_THROW(ReadHuntSimulation(scenario.name, "", {})) << scenario.name;
  }
  for (const Scenario& scenario : TouchdownScenarios()) {
    EXPECT_NO_THROW(ReadTouchdownSimulation(scenario.name, "", {})) << scenario.name;
  }
}

TEST(ScenariosTest, FileAndSettingsOverrideScenario) {
  const TestFolder folder;
  const std::string file =
      folder.Write("mine.yaml", "frames: 7\nrate_hz: 1\nvehicle:\n  speed_mps: 3\n");
  const LandingSimulationOptions options =
      ReadLandingSimulation("fast", file, {"vehicle.speed_mps=2"});
  EXPECT_EQ(options.recording.frames, 7);
  EXPECT_EQ(options.vehicle.speed_mps, 2);
  EXPECT_EQ(options.vehicle.radius_m, 26) << "the scenario's";
}

TEST(ScenariosTest, StillsMayBeFew) {
  EXPECT_NO_THROW(ReadLandingSimulation("stills", "", {"frames=1"}));
}

TEST(ScenariosTest, PrintedOptionsAreScenarioFile) {
  const TestFolder folder;
  const LandingSimulationOptions dust = ReadLandingSimulation("dust", "", {});
  const std::string file = folder.Write("dust.yaml", PrintOptions(dust));
  EXPECT_EQ(PrintOptions(ReadLandingSimulation("", file, {})), PrintOptions(dust));
}

TEST(ScenariosTest, RefusesMalformedScenarioFiles) {
  const TestFolder folder;
  const auto error = [&](const std::string& yaml) {
    const std::string file = folder.Write("bad.yaml", yaml);
    return InputErrorOf([&] { ReadLandingSimulation("", file, {}); });
  };
  EXPECT_THAT(error("vehicle:\n  sped_mps: 3\n"),
              HasSubstr("bad.yaml:2: unknown key 'vehicle.sped_mps', did you mean "
                        "'vehicle.speed_mps'?"));
  EXPECT_THAT(
      error("vehicle:\n  speed_mps: quick\n"),
      HasSubstr("bad.yaml:2: vehicle.speed_mps is 'quick', expected a finite number (m/s)"));
  EXPECT_THAT(error("pattern:\n  outer_diameter_m: -1\n"), HasSubstr("pattern.outer_diameter_m"));
  EXPECT_THAT(error("flight:\n  end_altitude_m: -0.5\n"),
              HasSubstr("flight.end_altitude_m is -0.5, expected 0.1 to 100"));
  EXPECT_THAT(error("frames: 3\n"), HasSubstr("frames / rate_hz is 0.10 s, expected at least 3."));
  EXPECT_THAT(
      error("ground:\n  material: lava\n"),
      HasSubstr("ground.material is 'lava', expected asphalt, concrete, sand, grass or water"));
  EXPECT_THAT(error("ground:\n  map_px: 1000\n"),
              HasSubstr("ground.map_px is 1000, expected a power of two"));
  EXPECT_THAT(InputErrorOf([] { ReadLandingSimulation("figure9", "", {}); }),
              HasSubstr("there is no scenario 'figure9', expected calm, aggressive, figure8"));
}

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

TEST(ScenarioFlightTest, CalmFlightAcceleratesLessThanLimitOfPaper) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Motion motion = FlightOf("calm", seed);
    for (double time_s = 0.5; time_s < 14.5; time_s += 0.1) {
      ASSERT_LT(AccelerationOf(motion, time_s).norm(), 0.25) << seed << " at " << time_s;
    }
  }
}

TEST(ScenarioFlightTest, AggressiveFlightTiltsTo40DegreesAndTurnsAt150PerSecond) {
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

}  // namespace
}  // namespace kestrel
