// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/cli/simulate_command.h"

#include <algorithm>
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
#include "kestrel/simulation/hunt_simulation.h"
#include "kestrel/simulation/landing_simulation.h"
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

// What `landing` and `hunt` differ in.
template <class Options>
struct Kind {
  std::span<const Scenario> scenarios;
  Options (*read)(const std::string& scenario, const std::string& config_file,
                  const std::vector<std::string>& settings);
  RecordingPlan (*plan)(const Options& options, const CameraCalibration& camera,
                        std::uint64_t seed);
  CameraCalibration camera;  // where none is given
};

template <class Options>
void Run(const Kind<Options>& kind, const SimulateArguments& arguments) {
  if (arguments.list) return PrintScenarios(kind.scenarios);
  const Options options = kind.read(arguments.scenario, arguments.config, arguments.settings);
  if (arguments.print_config) {
    std::cout << PrintOptions(options);
    return;
  }
  Render(kind.plan(options, FindCamera(arguments.camera, kind.camera), arguments.seed), arguments);
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

template <class Options>
void AddKind(CLI::App* command, const char* name, const char* meaning, const Kind<Options>& kind) {
  CLI::App* subcommand = command->add_subcommand(name, meaning);
  const auto arguments = std::make_shared<SimulateArguments>();
  AddArguments(subcommand, arguments.get());
  subcommand->callback([kind, arguments] { Run(kind, *arguments); });
}

}  // namespace

void AddSimulateCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand("simulate", "Render a flight with truth, as a recording");
  command->require_subcommand(1);
  AddKind(command, "landing",
          "A flight over the landing pattern on a vehicle (gray fisheye camera)",
          Kind<LandingSimulationOptions>{LandingScenarios(), ReadLandingSimulation, PlanLanding,
                                         PaperCalibration()});
  AddKind(command, "hunt", "A flight over coloured objects (colour camera, rolling shutter)",
          Kind<HuntSimulationOptions>{HuntScenarios(), ReadHuntSimulation, PlanHunt,
                                      HuntCalibration()});
}

}  // namespace kestrel
