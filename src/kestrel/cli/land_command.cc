// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/cli/land_command.h"

#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/cli/interrupt.h"
#include "kestrel/cli/progress_bar.h"
#include "kestrel/cli/source_arguments.h"
#include "kestrel/pipeline/landing_pipeline.h"
#include "kestrel/recording/annotated_writer.h"
#include "kestrel/recording/landing_csv.h"
#include "kestrel/recording/landing_overlay.h"
#include "kestrel/recording/open_source.h"
#include "kestrel/recording/output_folder.h"

namespace kestrel {
namespace {

// Where the results go: files below --output, or the CSV to stdout.
class LandingSink {
 public:
  LandingSink(const SourceArguments& arguments, double rate_hz) {
    if (!arguments.output.empty()) {
      folder_.emplace(arguments.output, arguments.force);
      file_ = folder_->OpenText("landing_detections.csv");
    }
    if (arguments.annotate == "images") annotated_ = MakeImageWriter(*folder_);
    if (arguments.annotate == "video") annotated_ = MakeVideoWriter(*folder_, rate_hz);
    WriteLine(LandingCsvHeader());
  }

  void Write(const Frame& frame, const LandingObservation& observation,
             const LandingPatternDetector& detector) {
    WriteLine(LandingCsvRow(frame.name, observation));
    if (!annotated_) return;
    annotated_->Write(frame.name, DrawLandingOverlay(frame.image, detector.camera(),
                                                     detector.options().pattern, observation));
  }

 private:
  // At once, for whoever reads along.
  void WriteLine(const std::string& line) {
    std::ostream& csv = file_.is_open() ? file_ : std::cout;
    if (!(csv << line << std::flush)) {
      throw InputError("landing_detections.csv: cannot be written, is the disk full?");
    }
  }

  std::optional<OutputFolder> folder_;
  std::ofstream file_;
  std::unique_ptr<AnnotatedWriter> annotated_;
};

class Summary {
 public:
  void Add(const LandingObservation& observation) {
    times_.Add(observation.detect_time);
    found_ += observation.report.detection.has_value();
  }
  std::size_t frames() const { return times_.frames(); }

  void Print() const {
    fmt::print(stderr, "{} frames, pattern found in {}{}\n", frames(), found_, times_.Summary());
  }

 private:
  DetectTimes times_;
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
    sink->Write(frame, observation, pipeline->detector());
    summary->Add(observation);
    progress.Show(summary->frames());
  }
}

void RunLand(const SourceArguments& arguments) {
  LandingPipelineOptions options = arguments.options.Read().landing;
  if (arguments.still) options.still = true;
  const std::unique_ptr<FrameSource> source = OpenSource(arguments.sources);
  const CameraCalibration calibration = arguments.FindCalibration(*source);
  LandingPipeline pipeline(calibration, options);
  pipeline.SetAltitude(arguments.altitude_m);
  LandingSink sink(arguments, source->rate_hz());
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
  const auto arguments = std::make_shared<SourceArguments>();
  arguments->AddTo(command);
  command->callback([arguments] { RunLand(*arguments); });
}

}  // namespace kestrel
