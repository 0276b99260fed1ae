// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/cli/land_command.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/cli/landing_sink.h"
#include "kestrel/cli/pipeline_run.h"
#include "kestrel/cli/source_arguments.h"

namespace kestrel {
namespace {

struct LandArguments {
  SourceArguments source;
  std::vector<double> predict_s;
};

class LandRun : public PipelineRun {
 public:
  LandRun(const OpenedSource& opened, const LandingPipelineOptions& options,
          const LandArguments& arguments, bool has_track)
      : pipeline_(opened.calibration, options),
        sink_(arguments.source.Output(opened), has_track, arguments.predict_s) {
    pipeline_.SetAltitude(arguments.source.altitude_m);
  }

  void AddPose(const PoseSample& pose) override { pipeline_.AddPose(pose); }

  Duration Process(const Frame& frame) override {
    const LandingObservation observation = pipeline_.Process(frame.image, frame.time);
    sink_.Write(frame, observation, pipeline_);
    ++poses_[observation.pose];
    found_ += observation.report.detection.has_value();
    return observation.detect_time;
  }

  std::string Found() const override { return fmt::format("pattern found in {}", found_); }

  // Only where there are poses for some of the frames; a source that has none is nothing unusual.
  std::string Remarks() const override {
    std::string remarks;
    for (const auto& [pose, count] : poses_) {
      if (pose == PoseLookup::kFound || pose == PoseLookup::kEmpty) continue;
      remarks += fmt::format("{} frames without a pose of the UAV: {}\n", count, ToString(pose));
    }
    return remarks;
  }

 private:
  LandingPipeline pipeline_;
  LandingSink sink_;
  std::map<PoseLookup, std::size_t> poses_;
  std::size_t found_ = 0;
};

void RunLand(const LandArguments& arguments) {
  LandingPipelineOptions options = arguments.source.options.Read().landing;
  if (arguments.source.still) options.still = true;
  const OpenedSource opened = arguments.source.Open(PixelFormat::kGray);
  const bool has_track = opened.has_world() && !options.still;
  if (!arguments.predict_s.empty() && !has_track) {
    fmt::print(stderr,
               "no prediction: it needs a source with poses, a camera with its mount (T_BS) and no "
               "--still\n");
  }
  LandRun run(opened, options, arguments, has_track);
  RunPipeline(opened, &run);
}

}  // namespace

void AddLandCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand("land", "Run the landing pipeline over a source");
  const auto arguments = std::make_shared<LandArguments>();
  arguments->source.AddTo(command);
  command
      ->add_option("--predict", arguments->predict_s,
                   "Also write where the target will be after these times (s), as 0.5,1.0")
      ->type_name("S,...")
      ->delimiter(',')
      ->needs("--output")
      ->check(InRange(0, 60, "seconds, above 0 and below 60"));
  command->callback([arguments] { RunLand(*arguments); });
}

}  // namespace kestrel
