// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/cli/land_command.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/cli/interrupt.h"
#include "kestrel/cli/landing_sink.h"
#include "kestrel/cli/progress_bar.h"
#include "kestrel/cli/source_arguments.h"
#include "kestrel/pipeline/landing_pipeline.h"
#include "kestrel/pipeline/pose_feeder.h"
#include "kestrel/recording/open_source.h"

namespace kestrel {
namespace {

struct LandArguments {
  SourceArguments source;
  std::vector<double> predict_s;
};

class Summary {
 public:
  void Add(const LandingObservation& observation) {
    times_.Add(observation.detect_time);
    ++poses_[observation.pose];
    found_ += observation.report.detection.has_value();
  }
  std::size_t frames() const { return times_.frames(); }

  void Print() const {
    fmt::print(stderr, "{} frames, pattern found in {}{}\n", frames(), found_, times_.Summary());
    PrintMissingPoses();
  }

 private:
  // Only where there are poses for some of the frames; a source that has none is nothing unusual.
  void PrintMissingPoses() const {
    for (const auto& [pose, count] : poses_) {
      if (pose == PoseLookup::kFound || pose == PoseLookup::kEmpty) continue;
      fmt::print(stderr, "{} frames without a pose of the UAV: {}\n", count, ToString(pose));
    }
  }

  DetectTimes times_;
  std::map<PoseLookup, std::size_t> poses_;
  std::size_t found_ = 0;
};

void ProcessFrames(FrameSource* source, const CameraCalibration& calibration,
                   LandingPipeline* pipeline, LandingSink* sink, Summary* summary) {
  const Duration clock_offset = calibration.clock_offset.value_or(Duration::zero());
  PoseFeeder poses(source->poses());
  ProgressBar progress(source->frame_count());
  Frame frame;
  while (!WasInterrupted() && source->Next(&frame)) {
    RequireSize(frame, calibration.intrinsics);
    poses.FeedUntil(frame.time + clock_offset, pipeline);
    const LandingObservation observation = pipeline->Process(frame.image, frame.time);
    sink->Write(frame, observation, *pipeline);
    summary->Add(observation);
    progress.Show(summary->frames());
  }
}

void RunLand(const LandArguments& arguments) {
  LandingPipelineOptions options = arguments.source.options.Read().landing;
  if (arguments.source.still) options.still = true;
  const std::unique_ptr<FrameSource> source = OpenSource(arguments.source.sources);
  const CameraCalibration calibration = arguments.source.FindCalibration(*source);
  const bool has_poses = !source->poses().empty();
  LandingPipeline pipeline(calibration, options);
  pipeline.SetAltitude(arguments.source.altitude_m);
  const bool has_track = has_poses && calibration.body_from_camera && !options.still;
  if (!arguments.predict_s.empty() && !has_track) {
    fmt::print(stderr,
               "no prediction: it needs a source with poses, a camera with its mount (T_BS) and no "
               "--still\n");
  }
  LandingSink sink({.folder = arguments.source.output,
                    .force = arguments.source.force,
                    .annotate = arguments.source.annotate,
                    .rate_hz = source->rate_hz(),
                    .has_track = has_track,
                    .predict_s = arguments.predict_s});
  Summary summary;
  CatchInterrupts();
  try {
    ProcessFrames(source.get(), calibration, &pipeline, &sink, &summary);
  } catch (const InputError&) {
    if (summary.frames() > 0) summary.Print();  // these stay
    throw;
  }
  summary.Print();
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
