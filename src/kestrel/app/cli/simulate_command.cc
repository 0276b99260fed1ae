// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/progress_bar.h"
#include "kestrel/app/cli/simulate_arguments.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/io/recording/euroc/recording_place.h"
#include "kestrel/simulation/recordings/follow_simulation.h"
#include "kestrel/simulation/recordings/hunt_simulation.h"
#include "kestrel/simulation/recordings/landing_simulation.h"
#include "kestrel/simulation/recordings/recording_plan.h"
#include "kestrel/simulation/recordings/scenarios.h"

namespace kestrel {
namespace {

void Render(const RecordingPlan& plan, const SimulateArguments& arguments, int wanted_threads) {
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  const int threads = wanted_threads > 0 ? wanted_threads : std::max(cores, 1);
  CatchInterrupts();
  ProgressBar progress(plan.image_count());
  const auto start = std::chrono::steady_clock::now();
  std::size_t rendered = 0;
  const bool complete =
      WriteRecording(plan, arguments.output, arguments.force, threads, [&](std::size_t done) {
        progress.Show(done);
        rendered = done;
        return !WasInterrupted();
      });
  if (!complete) {
    throw Interrupted(fmt::format("interrupted after {} of {} images; the same command goes on",
                                  rendered, plan.image_count()));
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  fmt::print(stderr, "{}: {} images in {:.1f} s\n", arguments.output, plan.image_count(),
             took.count());
}

// The parts in which `landing`, `hunt` and `follow` differ.
template <class Options>
struct Kind {
  std::span<const Scenario> scenarios;
  Options (*read)(const std::string& scenario, const std::string& config_file,
                  const std::vector<std::string>& settings);
  RecordingPlan (*plan)(const Options& options, const CameraCalibration& camera,
                        std::uint64_t seed);
  CameraCalibration camera;  // default
};

template <class Options>
void Run(const Kind<Options>& kind, const SimulateArguments& arguments, int threads) {
  if (arguments.list) return PrintScenarios(kind.scenarios);
  const Options options = kind.read(arguments.scenario, arguments.config, arguments.AllSettings());
  if (arguments.print_config) {
    std::cout << PrintOptions(options);
    return;
  }
  RequireFreeForRecording(arguments.output, arguments.force);
  RecordingPlan plan = kind.plan(options, arguments.FindCamera(kind.camera), arguments.seed);
  // An evaluation groups its results by the condition.
  if (!arguments.scenario.empty()) plan.scene += "condition: " + arguments.scenario + "\n";
  Render(plan, arguments, threads);
}

template <class Options>
std::shared_ptr<SimulateArguments> AddKind(CLI::App* command, const char* name, const char* meaning,
                                           const Kind<Options>& kind) {
  CLI::App* subcommand = command->add_subcommand(name, meaning);
  auto arguments = std::make_shared<SimulateArguments>();
  const auto threads = std::make_shared<int>(0);
  arguments->AddTo(subcommand);
  subcommand
      ->add_option("--threads", *threads, "Number of threads (default: as many as there are cores)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  subcommand->callback([=] { Run(kind, *arguments, *threads); });
  return arguments;
}

}  // namespace

void AddSimulateCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand("simulate", "Render a flight with truth, as a recording");
  command->require_subcommand(1);
  AddKind(command, "landing", "A flight over a pad on a vehicle (gray fisheye camera)",
          Kind<LandingSimulationOptions>{LandingScenarios(), ReadLandingSimulation, PlanLanding,
                                         PaperCalibration()})
      ->target.AddTo(command->get_subcommand("landing"));
  AddKind(command, "hunt", "A flight over coloured objects (colour camera, rolling shutter)",
          Kind<HuntSimulationOptions>{HuntScenarios(), ReadHuntSimulation, PlanHunt,
                                      HuntCalibration()});
  AddKind(command, "follow", "A flight beside a person, a car or a boat (colour camera)",
          Kind<FollowSimulationOptions>{FollowScenarios(), ReadFollowSimulation, PlanFollow,
                                        FollowCalibration()});
  AddTouchdownCommand(command);
}

}  // namespace kestrel
