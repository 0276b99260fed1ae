// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <string>
#include <sys/utsname.h>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/machine_benchmark.h"
#include "kestrel/app/evaluation/statistics.h"
#include "kestrel/version.h"

namespace kestrel {
namespace {

// Returns the computer's name as its maker says it: a board's, else that of its processor.
std::string MachineName() {
  std::string name;
  if (std::ifstream board("/proc/device-tree/model"); std::getline(board, name, '\0')) return name;
  std::ifstream processors("/proc/cpuinfo");
  for (std::string line; std::getline(processors, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string MachineInWords() {
  utsname system{};
  uname(&system);
  return fmt::format("{}, {}, {} cores", MachineName(), system.machine,
                     std::thread::hardware_concurrency());
}

void RunBenchmark() {
  const std::vector<StepTimes> steps =
      MeasureSteps([](const std::string& what) { fmt::print(stderr, "kestrel: {} ...\n", what); });
  std::string line = fmt::format("kestrel {} | {}", kVersion, MachineInWords());
  fmt::print(
      "{}\n\n| step | median ms | p99 ms | images/s on a core | of a core at 30 images/s |\n"
      "|---|---|---|---|---|\n",
      MachineInWords());
  for (const StepTimes& step : steps) {
    if (step.ms.empty()) {
      fmt::print("| {} | - | - | - | - |\n", step.step);
      continue;
    }
    const double median = Quantile(step.ms, 0.5);
    const double p99 = Quantile(step.ms, 0.99);
    fmt::print("| {} | {:.3f} | {:.3f} | ", step.step, median, p99);
    if (step.is_work) {
      fmt::print("{:.0f} | {:.1f} % |\n", 1e3 / median, 3 * median);
    } else {
      fmt::print("- | - |\n");
    }
    line += fmt::format(" | {:.3f} {:.3f}", median, p99);
  }
  fmt::print("\nThe line to send:\n{}\n", line);
}

}  // namespace

void AddBenchmarkCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand(
      "benchmark", "How fast this computer is, by simulated flights: a table and a line to send");
  command->callback(RunBenchmark);
}

}  // namespace kestrel
