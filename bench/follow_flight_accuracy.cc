// SPDX-License-Identifier: BSD-3-Clause
// Flies simulated autopilots beside a car or a person over MAVLink, in simulated time and without
// images, and prints how well they keep the distance that is asked for. Usage:
// follow_flight_accuracy [--flights N] [--first-seed N] [--case TEXT] [--seconds S]
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "flight_arguments.h"
#include "kestrel/simulation/autopilots/test_followed_flight.h"
#include "report_main.h"

namespace kestrel {
namespace {

struct Arguments : FlightArguments {
  double seconds = 60;
};

// A vehicle or a person, and the way in which it is followed.
struct Case {
  const char* name;
  const char* path;
  double speed_mps;
  double radius_m;
  const char* side;
  double distance_m;
  double height_m;
  double down_deg;  // of a fixed camera
};
constexpr Case kCases[] = {
    {"car, 30 km/h on the eight, free", "figure8", 8.33, 26, "free", 15, 10, 25},
    {"car, 30 km/h on the eight, south", "figure8", 8.33, 26, "180", 15, 10, 25},
    {"car, 15 km/h on the eight, free", "figure8", 4.2, 15, "free", 15, 10, 25},
    {"person, walks, stops, turns, free", "stops", 1.4, 15, "free", 8, 6, 35},
    {"person, walks, stops, turns, behind", "stops", 1.4, 15, "behind", 8, 6, 35},
};

AutopilotModelOptions ModelOf(AutopilotFirmware firmware, std::uint64_t seed) {
  AutopilotModelOptions options;
  // Each begins at another place of the path.
  options.pilot.guide_after_s = 4 + 0.9 * static_cast<double>(seed);
  options.pilot.land_after_s = -1;
  options.pilot.offset_east_m = 9;
  options.pilot.offset_north_m = -7;
  options.pilot.heading_deg = -52;  // towards the vehicle
  options.uav.multicopter.max_tilt_deg = 45;
  options.uav.multicopter.max_acceleration = 10;
  if (firmware == AutopilotFirmware::kArduPilot) {
    options.parameters = "ATC_ANGLE_MAX=45,WP_SPD=15,WP_ACC=6,PSC_JERK_NE=20";
  }
  return options;
}

FlightOptions FlightOf(const Case& flown) {
  FlightOptions options;
  options.guidance.limits.max_speed_mps = 12;
  options.guidance.limits.max_tilt_deg = 45;
  options.guidance.limits.geofence_radius_m = 500;
  options.guidance.follow = {
      .distance_m = flown.distance_m, .height_m = flown.height_m, .side = flown.side};
  return options;
}

struct Row {
  int followed = 0;
  std::vector<double> shares;
  double seen = 1, worst_m = 0, lowest_m = 1e9;
};

Row Fly(const Case& flown, AutopilotFirmware firmware, bool has_gimbal,
        const Arguments& arguments) {
  Row row;
  VehicleWorldOptions vehicle = TestVehicle(flown.path, flown.speed_mps);
  vehicle.vehicle.radius_m = flown.radius_m;
  for (int i = 0; i < arguments.flights; ++i) {
    const std::uint64_t seed = arguments.first_seed + static_cast<std::uint64_t>(i);
    AutopilotModelOptions model = ModelOf(firmware, seed);
    model.has_gimbal = has_gimbal;
    FollowedFlight flight(firmware, model, vehicle, FlightOf(flown),
                          has_gimbal ? std::nullopt : std::optional(flown.down_deg), seed);
    if (!flight.FollowWithin(60)) {
      fmt::print(stderr, "{}, seed {}: {}", flown.name, seed, flight.reported);
      continue;
    }
    ++row.followed;
    flight.Fly(5);
    const FollowedFlight::Result result = flight.FlyAndMeasure(arguments.seconds);
    row.shares.push_back(100 * result.share);
    row.seen = std::min(row.seen, result.seen_share);
    row.worst_m = std::max(row.worst_m, result.worst_m);
    row.lowest_m = std::min(row.lowest_m, result.lowest_m);
  }
  std::sort(row.shares.begin(), row.shares.end());
  return row;
}

void Print(const std::string& name, const char* autopilot, const char* camera, const Row& row,
           int flights) {
  double mean = 0;
  for (const double share : row.shares) mean += share / static_cast<double>(row.shares.size());
  fmt::print("| {} | {} | {} | {} of {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} |\n", name,
             autopilot, camera, row.followed, flights, mean,
             row.shares.empty() ? 0 : row.shares.front(), row.worst_m, 100 * row.seen,
             row.lowest_m);
  std::fflush(stdout);
}

void Run(const Arguments& arguments) {
  fmt::print(
      "| what is followed | autopilot | camera | followed | within 10 % of the distance, mean, % | "
      "worst flight, % | largest error, m | in view, worst flight, % | lowest, m |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (const Case& flown : kCases) {
    if (!arguments.Wants(flown.name)) continue;
    for (const bool has_gimbal : {false, true}) {
      for (const auto firmware : {AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4}) {
        const bool is_px4 = firmware == AutopilotFirmware::kPx4;
        Print(flown.name, is_px4 ? "sim:px4" : "sim:ardupilot", has_gimbal ? "gimbal" : "fixed",
              Fly(flown, firmware, has_gimbal, arguments), arguments.flights);
      }
    }
  }
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app{"Flights beside a car or a person, and how well they keep their distance"};
  kestrel::Arguments arguments;
  arguments.AddTo(&app);
  app.add_option("--seconds", arguments.seconds, "Duration of each, once it follows (60)")
      ->check(CLI::Range(1, 3600));
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] {
    kestrel::Run(arguments);
    return 0;
  });
}
