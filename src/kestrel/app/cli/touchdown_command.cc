// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/progress_bar.h"
#include "kestrel/app/cli/simulate_arguments.h"
#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/app/evaluation/touchdown_plot.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/flight/session/landing_files.h"
#include "kestrel/io/recording/euroc/recording_writer.h"
#include "kestrel/io/recording/output_folder.h"
#include "kestrel/simulation/recordings/landing_simulation.h"
#include "kestrel/simulation/recordings/touchdown_simulation.h"

namespace kestrel {
namespace {

struct TouchdownArguments {
  SimulateArguments shared;
  std::string annotate;  // "video", "images" or empty
};

void WriteText(const OutputFolder& folder, const char* name, const std::string& text) {
  std::ofstream file = folder.OpenText(name);
  WriteAtOnce(text, name, &file);
}

void WriteResult(const TouchdownResult& result, std::uint64_t seed, const OutputFolder& folder) {
  WriteText(folder, "touchdown.csv", TouchdownCsvHeader() + TouchdownCsvRow(seed, result));
  WriteText(folder, "touchdown_path.csv", TouchdownPathCsv(result));
  WriteText(folder, "summary.txt", InWords(result));
  WritePlot(TouchdownPlot(result), folder.NewFile("touchdown.png").string());
}

// Flies, and writes images and results during the flight. Returns nothing when interrupted.
std::optional<TouchdownResult> FlyInto(const RecordingWriter& writer, const std::string& annotate,
                                       double rate_hz, TouchdownSimulation* simulation) {
  std::optional<LandingFiles> files;
  CatchInterrupts();
  ProgressBar progress(std::nullopt);
  std::size_t done = 0;
  return simulation->Fly([&](const cv::Mat& image, const LandingObservation& observation,
                             const LandingPipeline& pipeline) {
    if (!files) {
      files.emplace(OutputOptions{writer.part().string(), /*force=*/true, annotate, rate_hz},
                    &pipeline, /*has_track=*/true, /*predict_s=*/std::vector<double>());
    }
    writer.WriteImage(observation.time, image);
    files->Take(
        {{RecordedImagePath(observation.time).string(), observation.time, image}, observation});
    progress.Show(++done);
    return !WasInterrupted();
  });
}

void Simulate(const TouchdownSimulationOptions& options, const TouchdownArguments& arguments) {
  const SimulateArguments& shared = arguments.shared;
  TouchdownSimulation simulation(options, shared.FindCamera(PaperCalibration()), shared.seed);
  const RecordingWriter writer(shared.output, shared.force, simulation.SceneText());
  const auto result = FlyInto(writer, arguments.annotate, options.recording.rate_hz, &simulation);
  if (!result) throw Interrupted("interrupted; the same command starts anew");
  WriteResult(*result, shared.seed, OutputFolder(writer.part(), /*replace_files=*/true));
  std::vector<Time> times;
  for (const TouchdownMoment& moment : result->path) times.push_back(moment.time);
  writer.Publish(times, simulation.Files());
  fmt::print("{}", InWords(*result));
}

void RunTouchdown(const TouchdownArguments& arguments) {
  const SimulateArguments& shared = arguments.shared;
  if (shared.list) return PrintScenarios(TouchdownScenarios());
  const auto options =
      ReadTouchdownSimulation(shared.scenario, shared.config, shared.AllSettings());
  if (shared.print_config) {
    std::cout << PrintOptions(options);
    return;
  }
  Simulate(options, arguments);
}

}  // namespace

void AddTouchdownCommand(CLI::App* simulate) {
  CLI::App* command = simulate->add_subcommand(
      "touchdown", "A simulated UAV lands on a moving vehicle by what the landing pipeline sees");
  const auto arguments = std::make_shared<TouchdownArguments>();
  arguments->shared.AddTo(command);
  arguments->shared.target.AddTo(command);
  AddAnnotateFlag(command, &arguments->annotate);
  command->callback([arguments] { RunTouchdown(*arguments); });
}

}  // namespace kestrel
