// SPDX-License-Identifier: BSD-3-Clause
// Flies simulated autopilots to discs of 0.2 m over MAVLink, in simulated time, and prints how near
// to their middle the gripper closes. Usage: go_accuracy [--flights N] [--first-seed N]
// [--case TEXT] [--rendered] [--log], or with --team N [--wind MPS]: N UAVs deliver the discs of
// the contest's field to its box.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "flight_arguments.h"
#include "kestrel/simulation/autopilots/test_team_flight.h"
#include "report_main.h"

namespace kestrel {
namespace {

struct Arguments : FlightArguments {
  bool is_rendered = false;
  bool logs = false;
  int team = 0;              // UAVs; 0: flights of one, to one disc
  double team_wind_mps = 0;  // steady; gusts are 0.5 of it
  double longest_s = 1200;
};

struct Case {
  const char* name;
  const char* class_name;
  const char* path;       // of discs that move
  double wind_mps;        // steady; gusts are 0.5 of it
  bool is_place = false;  // that it goes to, instead of a disc, to drop there
};
constexpr Case kCases[] = {
    {"stands, no wind", "red", "wander", 0},
    {"stands, gusts of 8 m/s", "red", "wander", 5.3},
    {"1.4 m/s, straight on, no wind", "yellow", "straight", 0},
    {"1.4 m/s, straight on, gusts of 8 m/s", "yellow", "straight", 5.3},
    {"0.6 m/s (RMS), wanders, no wind", "yellow", "wander", 0},
    {"0.6 m/s (RMS), wanders, gusts of 8 m/s", "yellow", "wander", 5.3},
    {"place, no wind", "red", "wander", 0, true},
    {"place, gusts of 8 m/s", "red", "wander", 5.3, true},
};

// 'wind_mps': as in Case.
AutopilotModelOptions ModelOf(double wind_mps) {
  AutopilotModelOptions options;
  options.pilot.guide_after_s = 5;
  options.pilot.land_after_s = -1;
  options.pilot.start_altitude_m = 6;
  options.uav.wind = {.min_mps = wind_mps, .max_mps = wind_mps, .gusts = 0.5};
  return options;
}

FlightOptions FlightOf() {
  FlightOptions options;
  options.guidance.search_altitude_m = 6;
  options.guidance.search_wait_s = 3;
  options.guidance.search_radius_m = 10;
  options.guidance.limits.geofence_radius_m = 500;
  return options;
}

std::vector<std::string> FieldOf(const Case& flown) {
  return {"ground.map_px=256",
          "field.length_m=14",
          "field.width_m=10",
          "field.objects.red=3",
          "field.objects.green=0",
          "field.objects.blue=0",
          "field.objects.yellow=3",
          std::string("field.objects.yellow_path=") + flown.path,
          flown.path == std::string("wander") ? "field.objects.yellow_speed_mps=0.6"
                                              : "field.objects.yellow_speed_mps=1.4"};
}

const Eigen::Vector2d kPlace(9, -7);  // m, world

GoFlightSetup SetupOf(const Case& flown, AutopilotFirmware firmware, std::uint64_t seed) {
  GoFlightSetup setup{.firmware = firmware,
                      .model = ModelOf(flown.wind_mps),
                      .field = FieldOf(flown),
                      .class_name = flown.class_name,
                      .flight = FlightOf(),
                      .seed = seed};
  if (!flown.is_place) return setup;
  setup.place = kPlace;
  setup.job = "drop,2.65";
  return setup;
}

struct Row {
  int taken = 0, within_5 = 0, within_10 = 0, tries = 0;
  std::vector<double> offsets_m, times_s;

  void Add(const SitlResult& result, bool is_done, const Case& flown) {
    const bool was_there =
        flown.is_place ? result.released_at.has_value() : result.grab.has_value();
    if (!was_there) return;
    const double offset_m =
        flown.is_place ? (result.released_at->head<2>() - kPlace).norm() : result.grab->offset_m;
    tries += flown.is_place ? 1 : result.grabs;
    taken += is_done && (flown.is_place || result.grab->is_taken) ? 1 : 0;
    offsets_m.push_back(offset_m);
    within_5 += offset_m <= 0.05 ? 1 : 0;
    within_10 += offset_m <= 0.1 ? 1 : 0;
  }
};

std::unique_ptr<GoFlight> MakeFlight(const GoFlightSetup& setup, bool is_rendered) {
  if (is_rendered) return std::make_unique<RenderedGoFlight>(setup);
  return std::make_unique<SightedGoFlight>(setup);
}

Row Fly(const Case& flown, AutopilotFirmware firmware, const Arguments& arguments) {
  constexpr double kLongest_s = 240;
  Row row;
  for (int i = 0; i < arguments.flights; ++i) {
    const std::uint64_t seed = arguments.first_seed + static_cast<std::uint64_t>(i);
    const auto flight = MakeFlight(SetupOf(flown, firmware, seed), arguments.is_rendered);
    const bool is_done = flight->FlyUntilDone(kLongest_s);
    const SitlResult& result = flight->model.result();
    if (arguments.logs || !is_done) {
      fmt::print(stderr, "{}, seed {}:\n{}{}", flown.name, seed, flight->reported, InWords(result));
    }
    row.Add(result, is_done, flown);
    row.times_s.push_back(ToSeconds(flight->now - kTestStart));
  }
  std::sort(row.offsets_m.begin(), row.offsets_m.end());
  std::sort(row.times_s.begin(), row.times_s.end());
  return row;
}

void Run(const Arguments& arguments) {
  fmt::print(
      "| disc | autopilot | taken | grabs | beside | within 0.05 m | within 0.10 m | offset, "
      "median, m | largest | time, median, s |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Case& flown : kCases) {
    if (!arguments.Wants(flown.name)) continue;
    for (const auto firmware : {AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4}) {
      const Row row = Fly(flown, firmware, arguments);
      const auto median = [](const std::vector<double>& sorted) {
        return sorted.empty() ? 0 : sorted[sorted.size() / 2];
      };
      fmt::print("| {} | {} | {} of {} | {} | {} | {} | {} | {:.3f} | {:.3f} | {:.0f} |\n",
                 flown.name, firmware == AutopilotFirmware::kPx4 ? "sim:px4" : "sim:ardupilot",
                 row.taken, arguments.flights, row.tries, row.tries - row.taken, row.within_5,
                 row.within_10, median(row.offsets_m),
                 row.offsets_m.empty() ? 0 : row.offsets_m.back(), median(row.times_s));
      std::fflush(stdout);
    }
  }
}

// The contest's field: ten discs that stand, ten that move, and a box beside them.
const Eigen::Vector2d kBox(0, -16);  // m, world
constexpr double kBoxRadius_m = 0.7;
constexpr int kDiscs = 10;

GoFlightSetup DeliveryOf(const char* class_name, AutopilotFirmware firmware, std::uint64_t seed,
                         int uav, const Arguments& arguments) {
  constexpr double kSpacing_m = 11, kRadius_m = 16;
  GoFlightSetup setup{
      .firmware = firmware,
      .model = ModelOf(arguments.team_wind_mps),
      .field = {"ground.map_px=256", "field.length_m=30", "field.width_m=20",
                "field.objects.red=10", "field.objects.green=0", "field.objects.blue=0",
                "field.objects.yellow=10", "field.objects.yellow_speed_mps=0.9"},
      .class_name = class_name,
      .box = kBox,
      .flight = FlightOf(),
      .seed = seed};
  setup.model.pilot.offset_east_m = kSpacing_m * (uav - 0.5 * (arguments.team - 1));
  setup.model.pilot.offset_north_m = 0;
  setup.flight.guidance.search_radius_m = kRadius_m;
  return setup;
}

void FlyTeam(const char* class_name, AutopilotFirmware firmware, const Arguments& arguments) {
  constexpr double kLook_s = 1;
  for (int i = 0; i < arguments.flights; ++i) {
    const std::uint64_t seed = arguments.first_seed + static_cast<std::uint64_t>(i);
    std::vector<GoFlightSetup> setups;
    for (int uav = 0; uav < arguments.team; ++uav) {
      setups.push_back(DeliveryOf(class_name, firmware, seed, uav, arguments));
    }
    TeamGoFlights flights(setups);
    flights.radio().loss = 0.1;
    const auto count = [&] { return flights.CountDelivered(kBox, kBoxRadius_m); };
    while (flights.seconds() < arguments.longest_s && count() < kDiscs) flights.Fly(kLook_s);
    if (arguments.logs) fmt::print(stderr, "nearest after {:.0f} s\n", flights.nearest_s);
    int grabs = 0;
    for (const auto& uav : flights.uavs) {
      grabs += uav->model.result().grabs;
      if (arguments.logs) {
        fmt::print(stderr, "seed {}, a UAV:\n{}{}", seed, uav->reported,
                   InWords(uav->model.result()));
      }
    }
    fmt::print("| {} | {} | {} | {} | {} | {} of {} | {} | {:.1f} | {:.0f} |\n", class_name,
               firmware == AutopilotFirmware::kPx4 ? "sim:px4" : "sim:ardupilot", arguments.team,
               seed, flights.CountTaken(), count(), kDiscs, grabs, flights.nearest_m,
               flights.seconds());
    std::fflush(stdout);
  }
}

void RunTeam(const Arguments& arguments) {
  fmt::print(
      "| discs | autopilot | UAVs | seed | taken | delivered | grabs | nearest approach, m | time, "
      "s "
      "|\n|---|---|---|---|---|---|---|---|---|\n");
  for (const char* class_name : {"red", "yellow"}) {
    if (!arguments.Wants(class_name)) continue;
    for (const auto firmware : {AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4}) {
      FlyTeam(class_name, firmware, arguments);
    }
  }
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app{"Flights to discs, and how near to their middle the gripper closes"};
  kestrel::Arguments arguments;
  arguments.AddTo(&app);
  app.add_flag("--rendered", arguments.is_rendered, "With rendered images, which takes minutes");
  app.add_flag("--log", arguments.logs, "Print what each flight reports");
  app.add_option("--team", arguments.team,
                 "So many UAVs deliver the discs of the contest's field; --case red: those that "
                 "stand, yellow: those that move")
      ->check(CLI::Range(1, 8));
  app.add_option("--wind", arguments.team_wind_mps,
                 "Steady wind of a team, m/s, with gusts of half of it (0)")
      ->check(CLI::Range(0.0, 15.0));
  app.add_option("--longest", arguments.longest_s, "Time after which a team stops, s (1200)");
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] {
    arguments.team > 0 ? kestrel::RunTeam(arguments) : kestrel::Run(arguments);
    return 0;
  });
}
