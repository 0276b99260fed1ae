// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/console_arguments.h"
#include "kestrel/app/cli/console_camera.h"
#include "kestrel/app/cli/console_study.h"
#include "kestrel/app/cli/fly_arguments.h"
#include "kestrel/app/cli/fly_command.h"
#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/page_links.h"
#include "kestrel/app/cli/recorded_run.h"
#include "kestrel/app/cli/result_argument.h"
#include "kestrel/app/console/calibration/calibration_tools.h"
#include "kestrel/app/console/colors/find_colors.h"
#include "kestrel/app/console/replay/recorded_autopilot.h"
#include "kestrel/app/console/replay/replay_console.h"
#include "kestrel/core/base/error.h"
#include "kestrel/flight/session/task.h"

namespace kestrel {
namespace {

constexpr std::size_t kFramesPerReport = 20;  // between two lines of progress on the page

void RunConsole(const ConsoleArguments& arguments) {
  CatchInterrupts();  // the page can be asked, and ended, before the first run begins
  const KestrelOptions options = arguments.source.options.Read();
  arguments.RequireEnd();
  const std::unique_ptr<ReplaySearch> search = MakeSearch(arguments, options);
  const RecordingChoice choice = arguments.source.Recording(search->format());
  const OpenedSource opened = OpenRecording(choice);
  const std::string& name = arguments.source.sources.front();
  std::optional<ColorSource> colors = FindColors(choice, arguments.model, arguments.OutputFolder());
  const bool has_colors = colors.has_value();
  if (!has_colors && !arguments.model.empty() && search->format() == PixelFormat::kGray) {
    throw InputError("--model: " + name + " has no images in color to teach it by");
  }
  ReplayConsole console(arguments.PageOptions(options), name, search->Subject(), std::move(colors));
  PrintLinks(console.urls());
  if (has_colors) fmt::print(stderr, "folder for taught colors: {}\n", arguments.OutputFolder());
  const auto start = arguments.result.empty() ? search->Detect({}) : search->Show(arguments.result);
  const ReplayRun run = start(opened);
  RunToEnd(opened, run.session.get(), [&](std::size_t done) {
    if (done % kFramesPerReport != 0) return;
    const std::size_t frames = opened.source->frame_count().value_or(0);
    console.SetProgress(fmt::format("{} of {} frames", done, frames));
  });
  if (WasInterrupted()) return;
  if (run.frames->done() == 0) throw InputError(name + ": has no images to show");
  console.OfferCalibration(CalibrationTools(arguments.source.Recording(PixelFormat::kGray),
                                            arguments.LandingOptions(options),
                                            arguments.OutputFolder()));
  ReplayResult result = run.frames->TakeResult();
  ReplayConsole::Recording recording = RecordingOf(choice, *search);
  recording.autopilot =
      ReadRecordedAutopilot(choice.sources, result.frames.front().time, result.frames.back().time);
  const std::string& fault = recording.autopilot.fault;
  if (!fault.empty()) fmt::print(stderr, "kestrel: warning: {}\n", fault);
  console.Play(std::move(result), std::move(recording), WasInterrupted);
}

// Shows a simulated UAV that lands on a simulated car, again and again.
void RunConsoleDemo(const ConsoleArguments& arguments) {
  FlyArguments flight;
  flight.source.sources = {"sim:figure8"};
  flight.source.options = arguments.source.options;
  flight.autopilot = "sim:px4";
  flight.guide = true;
  flight.console = arguments.address;
  FlyUntilInterrupted(flight);
}

}  // namespace

void AddConsoleCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand(
      "console",
      "Serve the web page for a camera (picture, focus, guided calibration of its lens), a "
      "recording "
      "(replay, calibration, teaching of colours) or the folder of `kestrel study run` (what got "
      "worst)");
  const auto arguments = std::make_shared<ConsoleArguments>();
  arguments->source.AddReadingTo(command);
  CLI::Option* const source = command->get_option("SOURCE")->required(false);
  command
      ->add_flag("--demo", arguments->is_demo,
                 "In place of a SOURCE: simulated landings on a driving car, until Ctrl-C")
      ->excludes(source);
  command
      ->add_option("--address", arguments->address,
                   "Address of the page (127.0.0.1:8080); port 0: any free one")
      ->type_name("ADDRESS:PORT");
  arguments->task.AddTo(command, HasSearch);
  command
      ->add_option("--model", arguments->model,
                   "Objects (YAML) whose colours the page teaches, in place of those saved before "
                   "or the built-in ones; with --hunt also the objects of the search")
      ->type_name("FILE");
  command
      ->add_option("--output", arguments->output,
                   "Folder for what the page saves: calibrations, and the model that it teaches "
                   "(objects.yaml), its versions and the draft (taught; of a camera: this folder)")
      ->type_name("DIR");
  command->callback([arguments] {
    if (arguments->is_demo) return RunConsoleDemo(*arguments);
    if (arguments->source.sources.empty()) throw CLI::RequiredError("SOURCE, or --demo,");
    if (IsStudy(*arguments)) return RunStudyConsole(*arguments);
    if (arguments->IsLive()) return RunCameraConsole(*arguments);
    const std::string table(MakeTask(arguments->task.name, TaskOptions())->table());
    arguments->result = TakeResult(table, &arguments->source.sources).value_or("");
    RunConsole(*arguments);
  });
}

}  // namespace kestrel
