// SPDX-License-Identifier: BSD-3-Clause
// Simulates many touchdowns in closed loop, and prints how many land, how long they take and how
// far from the centre and from the wanted heading. Usage: touchdown_accuracy [--scenario NAME]...
// [--target KIND] [--flights N] [--first-seed N] [--set K=V]...
#include <cmath>
#include <cstdint>
#include <iostream>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "for_each_index.h"
#include "kestrel/app/evaluation/statistics.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/recordings/landing_simulation.h"
#include "kestrel/simulation/recordings/scenarios.h"
#include "kestrel/simulation/recordings/touchdown_simulation.h"
#include "report_main.h"

namespace kestrel {
namespace {

struct Arguments {
  std::vector<std::string> scenarios = {"figure8", "fast"};
  std::vector<std::string> settings;
  int flights = 20;
  std::uint64_t first_seed = 1;
};

TouchdownResult Fly(const TouchdownSimulationOptions& options, std::uint64_t seed) {
  TouchdownSimulation simulation(options, PaperCalibration(), seed);
  return *simulation.Fly([](const auto&...) { return true; });
}

// Flies one flight on each core at a time; prints the rows as they are done.
std::vector<TouchdownResult> FlyAll(const TouchdownSimulationOptions& options,
                                    const Arguments& arguments) {
  std::vector<TouchdownResult> results(arguments.flights);
  std::mutex mutex;
  ForEachIndex(arguments.flights, [&](std::size_t i) {
    results[i] = Fly(options, arguments.first_seed + i);
    const std::lock_guard lock(mutex);
    std::cout << TouchdownCsvRow(arguments.first_seed + i, results[i]) << std::flush;
  });
  return results;
}

// Returns a row of the table.
std::string Summary(const std::string& scenario, const std::vector<TouchdownResult>& results) {
  std::vector<double> times_s, distances_m, slips_mps, headings_deg;
  for (const TouchdownResult& result : results) {
    if (result.outcome != TouchdownOutcome::kLanded) continue;
    times_s.push_back(result.time_s);
    distances_m.push_back(result.distance_m);
    slips_mps.push_back(result.slip_mps);
    if (result.heading_error) headings_deg.push_back(Degrees(std::abs(*result.heading_error)));
  }
  const auto spread = [](const std::vector<double>& values) {
    return values.empty() ? "- | - | -"
                          : fmt::format("{:.2f} | {:.2f} | {:.2f}", Median(values),
                                        Quantile(values, 0.95), Quantile(values, 1));
  };
  return fmt::format("| {} | {} of {} | {} | {} | {} | {} |\n", scenario, times_s.size(),
                     results.size(), spread(times_s), spread(distances_m), spread(slips_mps),
                     spread(headings_deg));
}

void Run(const Arguments& arguments) {
  std::string summaries;
  for (const std::string& scenario : arguments.scenarios) {
    const auto options = ReadTouchdownSimulation(scenario, "", arguments.settings);
    fmt::print("== {}\n{}", scenario, TouchdownCsvHeader());
    std::cout << std::flush;
    summaries += Summary(scenario, FlyAll(options, arguments));
  }
  fmt::print(
      "\n| scenario | landed | time median, s | time 95 %, s | time worst, s | distance median, m "
      "| distance 95 %, m | distance worst, m | slip median, m/s | slip 95 %, m/s | slip worst, "
      "m/s "
      "| heading error median, degrees | heading error 95 %, degrees "
      "| heading error worst, degrees "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n{}",
      summaries);
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app{"Many simulated touchdowns and how well they hit"};
  kestrel::Arguments arguments;
  app.add_option("--scenario", arguments.scenarios,
                 "Of `kestrel simulate touchdown`; may be given again (figure8, fast)")
      ->allow_extra_args(false);
  app.add_option("--flights", arguments.flights, "How many, each with the next seed (20)")
      ->check(CLI::Range(1, 100000));
  app.add_option("--first-seed", arguments.first_seed, "Seed of the first flight (1)");
  app.add_option("--set", arguments.settings, "One option, as key=value; may be given again")
      ->allow_extra_args(false);
  app.add_option_function<std::string>(
      "--target",
      [&](const std::string& kind) {
        arguments.settings.insert(arguments.settings.begin(), "target.kind=" + kind);
      },
      "Kind of the pad (ring-cross); the file of its board: --set target.nested.board=FILE");
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] {
    kestrel::Run(arguments);
    return 0;
  });
}
