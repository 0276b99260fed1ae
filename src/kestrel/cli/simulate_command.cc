// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/cli/simulate_command.h"

#include <cstdint>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/base/options.h"
#include "kestrel/camera/calibration_reader.h"
#include "kestrel/cli/interrupt.h"
#include "kestrel/cli/progress_bar.h"
#include "kestrel/simulation/recording_plan.h"
#include "kestrel/simulation/scenarios.h"

namespace kestrel {
namespace {

struct SimulateArguments {
  std::string output;
  std::string scenario;
  std::string config;
  std::vector<std::string> settings;
  std::string camera;
  std::uint64_t seed = 1;
  int threads = 0;
  bool list = false;
  bool print_config = false;
  bool force = false;
};

void PrintScenarios(std::span<const Scenario> scenarios) {
  for (const Scenario& scenario : scenarios) {
    fmt::print("{:<12}{}\n", scenario.name, scenario.meaning);
  }
}

// The file's lens; what it does not say of the mount is the default camera's.
CameraCalibration FindCamera(const std::string& file, const CameraCalibration& by_default) {
  if (file.empty()) return by_default;
  CameraCalibration camera = ReadCalibration(file);
  if (!camera.body_from_camera) camera.body_from_camera = by_default.body_from_camera;
  return camera;
}

void Render(const RecordingPlan& plan, const SimulateArguments& arguments) {
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  const int threads = arguments.threads > 0 ? arguments.threads : std::max(cores, 1);
  CatchInterrupts();
  ProgressBar progress(plan.times.size());
  std::size_t rendered = 0;
  const bool complete =
      WriteRecording(plan, arguments.output, arguments.force, threads, [&](std::size_t done) {
        progress.Show(done);
        rendered = done;
        return !WasInterrupted();
      });
  if (!complete) {
    throw InputError(fmt::format("interrupted after {} of {} images; the same command goes on",
                                 rendered, plan.times.size()));
  }
  fmt::print(stderr, "{}: {} images\n", arguments.output, plan.times.size());
}

void RunLanding(const SimulateArguments& arguments) {
  if (arguments.list) return PrintScenarios(LandingScenarios());
  const LandingSimulationOptions options =
      ReadLandingSimulation(arguments.scenario, arguments.config, arguments.settings);
  if (arguments.print_config) {
    std::cout << PrintOptions(options);
    return;
  }
  Render(
      PlanLanding(options, FindCamera(arguments.camera, PaperCalibration()), arguments.seed),
      arguments);
}

void AddArguments(CLI::App* command, SimulateArguments* arguments) {
  CLI::Option* output =
      command->add_option("--output", arguments->output, "Folder for the recording")
          ->type_name("DIR");
  command->add_option("--seed", arguments->seed, "Same seed, same recording (default 1)")
      ->type_name("N");
  command->add_option("--scenario", arguments->scenario, "A named flight, see --list")
      ->type_name("NAME");
  command
      ->add_option("--config", arguments->config,
                   "Options from a YAML file (see --print-config), over the scenario's")
      ->type_name("FILE");
  command->add_option("--set", arguments->settings, "One option, as key=value; may be given again")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("--camera", arguments->camera, "Calibration of the camera to simulate")
      ->type_name("FILE");
  command->add_option("--threads", arguments->threads, "Default: as many as there are cores")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--force", arguments->force, "Replace a recording that exists");
  CLI::Option* list = command->add_flag("--list", arguments->list, "Print the scenarios");
  CLI::Option* print = command->add_flag("--print-config", arguments->print_config,
                                         "Print all options with their values, as YAML");
  command->parse_complete_callback([=] {
    if (output->count() + list->count() + print->count() == 0) {
      throw CLI::RequiredError("--output");
    }
  });
}

}  // namespace

void AddSimulateCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand("simulate", "Render a flight with truth, as a recording");
  command->require_subcommand(1);
  CLI::App* landing = command->add_subcommand(
      "landing", "A flight over the landing pattern on a vehicle (fisheye camera)");
  const auto arguments = std::make_shared<SimulateArguments>();
  AddArguments(landing, arguments.get());
  landing->callback([arguments] { RunLanding(*arguments); });
}

}  // namespace kestrel
