// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/scenarios.h"

#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/simulation/scene/vehicle_scenarios.h"

namespace kestrel {
namespace {

const std::vector<Scenario>& AllLandingScenarios() {
  static const std::vector<Scenario> scenarios = {
      {"calm",
       "over a standing vehicle from 4.5 to 0.8 m, below 0.2 m/s^2, good light and navigation",
       {"vehicle.path=standing", "flight.start_altitude_m=4.5", "flight.end_altitude_m=0.8",
        "flight.sway_acceleration=0.05", "flight.offset_m=0.08", "flight.yaw_rate_deg=4",
        "flight.attitude_noise_deg=0.1", "navigation.position_noise_m=0.005",
        "navigation.position_drift_m=0", "navigation.position_bias_m=0",
        "navigation.attitude_noise_deg=0.05", "navigation.attitude_bias_deg=0",
        "ground.shadows=false", "frames=450"}},
      {"aggressive",
       "tilt to 40 degrees and 150 degrees/s over a car on a circle, from 10 to 0.8 m",
       {"vehicle.path=circle", "vehicle.radius_m=12", "vehicle.speed_mps=4.2", "board.carrier=car",
        "flight.start_altitude_m=10", "flight.end_altitude_m=0.8", "flight.sway_acceleration=8",
        "flight.sway_period_s=1.9", "flight.yaw_rate_deg=30", "frames=450"}},
      {"figure8",
       "the contest: a pick-up at 15 km/h on a figure of eight, from 13 m to touchdown",
       {"vehicle.path=figure8", "vehicle.speed_mps=4.2", "flight.start_altitude_m=13",
        "flight.end_altitude_m=0.4", "frames=450"}},
      {"fast",
       "a car at 30 km/h on a wide figure of eight, from 12 to 0.8 m",
       {"vehicle.speed_mps=8.33", "vehicle.radius_m=26", "board.carrier=car",
        "flight.start_altitude_m=12", "flight.end_altitude_m=0.8", "flight.sway_acceleration=1.5",
        "flight.sway_period_s=3", "flight.yaw_rate_deg=20", "ground.material=concrete",
        "frames=360"}},
      {"dark",
       "at dusk: little light, long exposure, strong noise",
       {"light.direct=0", "light.sky_radiance=0.5", "sensor.white_level=60", "sensor.black_level=8",
        "sensor.read_noise=3", "sensor.shot_noise=3", "shutter.exposure_s=0.008",
        "sensor.gain_variation=0.1", "flight.start_altitude_m=10", "flight.end_altitude_m=0.8",
        "frames=360"}},
      {"dust",
       "in clouds of dust over sand",
       {"ground.material=sand", "ground.markings=3", "ground.shadows=false",
        "light.visibility_m=18", "light.dust_clouds=0.6", "light.direct=0.5",
        "sensor.gain_variation=0.05", "flight.start_altitude_m=10", "flight.end_altitude_m=0.8",
        "frames=360"}},
      {"low-sun",
       "a low sun: long shadows, glare on the board, a bright sky",
       {"light.sun_elevation_deg=16", "light.direct=0.85", "light.sky_radiance=1.6",
        "board.gloss=1.5", "board.gloss_width_deg=25", "light.flare=1.5", "vehicle.path=circle",
        "flight.start_altitude_m=11", "flight.end_altitude_m=0.8", "ground.material=concrete",
        "frames=360"}},
      {"stills",
       "single images of the pattern, each with its own pose, ground, light and blur",
       {"stills.show=pattern", "frames=200"}},
      {"lookalikes",
       "single images without the pattern, but with things that look like it",
       {"stills.show=lookalikes", "frames=200"}},
  };
  return scenarios;
}

const std::vector<Scenario>& AllHuntScenarios() {
  static const std::vector<Scenario> scenarios = {
      {"sweep", "to and fro at 6 m over coloured discs, with distractors", {}},
      {"descend",
       "from 6 m down to 0.8 m over a disc, into the UAV's own shadow",
       {"flight.path=descend", "flight.length_m=10", "flight.width_m=8", "banners=1", "vehicles=0",
        "light.sun_elevation_deg=70", "frames=200"}},
      {"cuboids",
       "to and fro at 4.5 m over cuboids with digits, on sand",
       {"objects.shape=cuboid", "objects.red=7", "objects.green=7", "objects.blue=6",
        "objects.yellow=0", "objects.orange=0", "objects.orange_bars=0", "flight.altitude_m=4.5",
        "flight.speed_mps=2.5", "flight.length_m=20", "flight.width_m=12", "flight.lane_m=4",
        "ground.material=sand"}},
  };
  return scenarios;
}

const std::vector<Scenario>& AllFollowScenarios() {
  static const std::vector<Scenario> scenarios = {
      {"person", "beside a person who walks, stops and turns", {}},
      {"car",
       "beside a car at 30 km/h on a wide figure of eight",
       {"thing.kind=car", "motion.path=figure8", "motion.speed_mps=8.33", "motion.radius_m=40",
        "flight.distance_m=15", "flight.height_m=10"}},
      {"boat",
       "beside a boat that sails on a circle",
       {"thing.kind=boat", "motion.path=circle", "motion.speed_mps=4", "motion.radius_m=40",
        "motion.shake_deg=2", "flight.distance_m=18", "flight.height_m=12", "ground.material=water",
        "ground.markings=0", "ground.details=0", "ground.curb=false", "ground.shadows=false"}},
  };
  return scenarios;
}

// The airframe, the limits and the tracker for a vehicle at 80 km/h or on waves; the UAV flies
// behind the vehicle already when that is faster than the UAV could come up with.
constexpr std::array kSwift = {
    "touchdown.starts_behind=true",     "touchdown.start_distance_m=8",
    "multicopter.max_speed_mps=30",     "multicopter.drag=0.1",
    "guidance.limits.max_speed_mps=30", "guidance.limits.geofence_radius_m=3000",
    "tracker.max_speed_mps=40",         "tracker.climb_noise=0.5"};

std::vector<Scenario> MakeTouchdownScenarios() {
  std::vector<Scenario> scenarios = {
      {"figure8", "the contest: onto a pick-up at 15 km/h on a figure of eight", {}},
      {"fast",
       "onto a car at 30 km/h on a wide figure of eight",
       {"vehicle.speed_mps=8.33", "vehicle.radius_m=26", "board.carrier=car",
        "ground.material=concrete"}},
      {"gusts",
       "the contest in a wind of 8 m/s with gusts to 12",
       {"wind.min_mps=8", "wind.max_mps=8", "wind.gusts=0.25", "multicopter.max_tilt_deg=45",
        "multicopter.max_acceleration=10", "guidance.limits.max_tilt_deg=45"}},
  };
  for (const VehicleScenario& vehicle : HardVehicles()) {
    scenarios.push_back({vehicle.name, vehicle.meaning, vehicle.settings});
    auto& settings = scenarios.back().settings;
    settings.insert(settings.end(), kSwift.begin(), kSwift.end());
  }
  return scenarios;
}

const std::vector<Scenario>& AllTouchdownScenarios() {
  static const std::vector<Scenario> scenarios = MakeTouchdownScenarios();
  return scenarios;
}

const Scenario& FindScenario(std::span<const Scenario> scenarios, const std::string& name) {
  std::vector<const char*> names;
  for (const Scenario& scenario : scenarios) {
    if (name == scenario.name) return scenario;
    names.push_back(scenario.name);
  }
  throw InputError(
      fmt::format("there is no scenario '{}', expected {}", name, fmt::join(names, ", ")));
}

template <class Options>
Options ReadSimulation(std::span<const Scenario> scenarios, const std::string& scenario,
                       const std::string& config_file, const std::vector<std::string>& settings) {
  Options options;
  if (!scenario.empty()) {
    for (const char* setting : FindScenario(scenarios, scenario).settings) {
      SetOption(setting, &options);
    }
  }
  if (!config_file.empty()) ReadOptions(config_file, &options);
  for (const std::string& setting : settings) SetOption(setting, &options);
  RequireValid(options);
  return options;
}

}  // namespace

std::span<const Scenario> LandingScenarios() { return AllLandingScenarios(); }

LandingSimulationOptions ReadLandingSimulation(const std::string& scenario,
                                               const std::string& config_file,
                                               const std::vector<std::string>& settings) {
  return ReadSimulation<LandingSimulationOptions>(LandingScenarios(), scenario, config_file,
                                                  settings);
}

std::span<const Scenario> HuntScenarios() { return AllHuntScenarios(); }

HuntSimulationOptions ReadHuntSimulation(const std::string& scenario,
                                         const std::string& config_file,
                                         const std::vector<std::string>& settings) {
  return ReadSimulation<HuntSimulationOptions>(HuntScenarios(), scenario, config_file, settings);
}

std::span<const Scenario> TouchdownScenarios() { return AllTouchdownScenarios(); }

TouchdownSimulationOptions ReadTouchdownSimulation(const std::string& scenario,
                                                   const std::string& config_file,
                                                   const std::vector<std::string>& settings) {
  return ReadSimulation<TouchdownSimulationOptions>(TouchdownScenarios(), scenario, config_file,
                                                    settings);
}

RecordingPlan PlanLandingScenario(const std::string& scenario,
                                  const std::vector<std::string>& settings,
                                  const CameraCalibration& camera, std::uint64_t seed) {
  return PlanLanding(ReadLandingSimulation(scenario, "", settings), camera, seed);
}

std::span<const Scenario> FollowScenarios() { return AllFollowScenarios(); }

FollowSimulationOptions ReadFollowSimulation(const std::string& scenario,
                                             const std::string& config_file,
                                             const std::vector<std::string>& settings) {
  return ReadSimulation<FollowSimulationOptions>(FollowScenarios(), scenario, config_file,
                                                 settings);
}

RecordingPlan PlanHuntScenario(const std::string& scenario,
                               const std::vector<std::string>& settings,
                               const CameraCalibration& camera, std::uint64_t seed) {
  return PlanHunt(ReadHuntSimulation(scenario, "", settings), camera, seed);
}

}  // namespace kestrel
