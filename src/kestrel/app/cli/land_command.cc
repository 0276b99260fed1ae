// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/recorded_run.h"
#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/flight/session/landing_files.h"
#include "kestrel/flight/session/landing_run.h"
#include "kestrel/flight/session/observation_sinks.h"

namespace kestrel {
namespace {

struct LandArguments {
  SourceArguments source;
  std::vector<double> predict_s;
};

void RunLand(const LandArguments& arguments) {
  const KestrelOptions all_options = arguments.source.options.Read();
  LandingPipelineOptions options = all_options.landing;
  if (arguments.source.still) options.still = true;
  const OpenedSource opened = arguments.source.OpenOrAssume(PixelFormat::kGray);
  opened.source->set_keeps_color(!arguments.source.annotate.empty());
  const bool has_track = opened.has_world() && !options.still;
  if (!arguments.predict_s.empty() && !has_track) {
    fmt::print(stderr,
               "no prediction: it needs a source with poses, a camera with its mount (T_BS) and no "
               "--still\n");
  }
  LandingRun landing(opened, options, arguments.source.altitude_m);
  ObservationSinks sinks(SinkErrors::kThrow);
  AddDdsSink(arguments.source, opened, all_options, has_track, /*model=*/{}, &sinks);
  AddMcapSink(arguments.source, opened, ViewOf(opened.calibration, options), &sinks);
  sinks.Add(std::make_unique<LandingFiles>(arguments.source.Output(opened), &landing.pipeline(),
                                           has_track, arguments.predict_s));
  RunToEnd(opened, &landing, &sinks);
}

}  // namespace

void AddLandCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand("land", "Run the landing pipeline over a source");
  const auto arguments = std::make_shared<LandArguments>();
  arguments->source.AddTo(command);
  arguments->source.options.target.AddTo(command);
  command
      ->add_option("--predict", arguments->predict_s,
                   "Horizons (s) of predictions of the target that are written, too, as 0.5,1.0")
      ->type_name("S,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->needs("--output")
      ->check(InRange(0, 60, "seconds, above 0 and below 60"));
  command->callback([arguments] { RunLand(*arguments); });
}

}  // namespace kestrel
