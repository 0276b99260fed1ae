// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/cli/land_command.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/base/parse_number.h"
#include "kestrel/camera/calibration_reader.h"
#include "kestrel/cli/interrupt.h"
#include "kestrel/cli/option_arguments.h"
#include "kestrel/cli/progress_bar.h"
#include "kestrel/pipeline/landing_pipeline.h"
#include "kestrel/recording/annotated_writer.h"
#include "kestrel/recording/landing_csv.h"
#include "kestrel/recording/landing_overlay.h"
#include "kestrel/recording/open_source.h"
#include "kestrel/recording/output_folder.h"
#include "kestrel/recording/track_csv.h"

namespace kestrel {
namespace {

constexpr double kMaxClockOffset = 1e6;

struct LandArguments {
  std::vector<std::string> sources;
  std::string camera;
  OptionArguments options;
  std::string output;
  std::string annotate;  // "video", "images" or empty
  bool still = false;
  bool force = false;
  std::optional<double> altitude_m;
  std::optional<double> clock_offset;
  std::vector<double> predict_s;
};

// A FILE without a mount takes the source's, and its clock offset.
CameraCalibration FindCalibration(const LandArguments& arguments, const FrameSource& source) {
  const std::string own_file = source.calibration_file();
  if (arguments.camera.empty() && own_file.empty()) {
    throw InputError(
        "no calibration: the source has none, give one by --camera FILE (EuRoC sensor.yaml, Kalibr "
        "camchain.yaml, ROS camera_info YAML or OpenCV YAML)");
  }
  CameraCalibration calibration =
      ReadCalibration(arguments.camera.empty() ? own_file : arguments.camera);
  if (!calibration.body_from_camera && !own_file.empty()) {
    const CameraCalibration own = ReadCalibration(own_file);
    calibration.body_from_camera = own.body_from_camera;
    if (!calibration.clock_offset) calibration.clock_offset = own.clock_offset;
  }
  if (arguments.clock_offset) {
    calibration.clock_offset = DurationFromSeconds(*arguments.clock_offset);
  }
  return calibration;
}

void RequireSize(const Frame& frame, const CameraIntrinsics& intrinsics) {
  if (frame.image.cols == intrinsics.width_px && frame.image.rows == intrinsics.height_px) return;
  throw InputError(fmt::format("{}: the image has {} x {} px, but the calibration is for {} x {}",
                               frame.name, frame.image.cols, frame.image.rows, intrinsics.width_px,
                               intrinsics.height_px));
}

// Gives the pipeline the poses in the order of time, one further than the frame needs.
class PoseFeeder {
 public:
  explicit PoseFeeder(std::vector<PoseSample> poses) : poses_(std::move(poses)) {}

  void FeedUntil(Time time, LandingPipeline* pipeline) {
    while (next_ < poses_.size() && (next_ == 0 || poses_[next_ - 1].time < time)) {
      pipeline->AddPose(poses_[next_++]);
    }
  }

 private:
  std::vector<PoseSample> poses_;
  std::size_t next_ = 0;
};

void WriteLine(const std::string& line, const char* name, std::ostream* csv) {
  // At once, for whoever reads along.
  if (!(*csv << line << std::flush)) {
    throw InputError(std::string(name) + ": cannot be written, is the disk full?");
  }
}

// The files of the track, for a flight in which the target can be followed.
class TrackSink {
 public:
  TrackSink(const OutputFolder& folder, const std::vector<double>& horizons_s)
      : track_(folder.OpenText(kTrack)) {
    WriteLine(TrackCsvHeader(), kTrack, &track_);
    if (horizons_s.empty()) return;
    for (const double horizon_s : horizons_s) horizons_.push_back(DurationFromSeconds(horizon_s));
    prediction_ = folder.OpenText(kPrediction);
    WriteLine(PredictionCsvHeader(), kPrediction, &prediction_);
  }

  void Write(const LandingObservation& observation, const TargetTracker& tracker) {
    has_begun_ = has_begun_ || observation.fate;
    if (!has_begun_) return;
    WriteLine(TrackCsvRow(observation), kTrack, &track_);
    if (observation.track_state == TrackState::kSearching) return;
    for (const Duration horizon : horizons_) {
      const auto prediction = tracker.Predict(observation.time + horizon);
      if (!prediction) continue;
      WriteLine(PredictionCsvRow(observation.time, *prediction), kPrediction, &prediction_);
    }
  }

 private:
  static constexpr char kTrack[] = "landing_track.csv";
  static constexpr char kPrediction[] = "landing_prediction.csv";

  std::ofstream track_, prediction_;
  std::vector<Duration> horizons_;
  bool has_begun_ = false;
};

// Where the results go: files below --output, or the CSV to stdout.
class LandingSink {
 public:
  LandingSink(const LandArguments& arguments, const FrameSource& source, bool has_track) {
    if (!arguments.output.empty()) {
      folder_.emplace(arguments.output, arguments.force);
      file_ = folder_->OpenText(kDetections);
      if (has_track) track_.emplace(*folder_, arguments.predict_s);
    }
    if (arguments.annotate == "images") annotated_ = MakeImageWriter(*folder_);
    if (arguments.annotate == "video") annotated_ = MakeVideoWriter(*folder_, source.rate_hz());
    WriteLine(LandingCsvHeader(), kDetections, &csv());
  }

  void Write(const Frame& frame, const LandingObservation& observation,
             const LandingPipeline& pipeline) {
    WriteLine(LandingCsvRow(frame.name, observation), kDetections, &csv());
    if (track_) track_->Write(observation, pipeline.tracker());
    if (!annotated_) return;
    const LandingPatternDetector& detector = pipeline.detector();
    annotated_->Write(frame.name, DrawLandingOverlay(frame.image, detector.camera(),
                                                     detector.options().pattern, observation));
  }

 private:
  static constexpr char kDetections[] = "landing_detections.csv";

  std::ostream& csv() { return file_.is_open() ? file_ : std::cout; }

  std::optional<OutputFolder> folder_;
  std::ofstream file_;
  std::optional<TrackSink> track_;
  std::unique_ptr<AnnotatedWriter> annotated_;
};

class Summary {
 public:
  void Add(const LandingObservation& observation) {
    detect_ms_.push_back(1e3 * ToSeconds(observation.detect_time));
    ++poses_[observation.pose];
    found_ += observation.report.detection.has_value();
  }
  std::size_t frames() const { return detect_ms_.size(); }

  void Print() {
    std::sort(detect_ms_.begin(), detect_ms_.end());
    fmt::print(stderr, "{} frames, pattern found in {}", frames(), found_);
    if (frames() > 0) {
      fmt::print(stderr, ", detect_ms median {:.2f}, p99 {:.2f}", Quantile(0.5), Quantile(0.99));
    }
    fmt::print(stderr, "\n");
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

  // By nearest rank; detect_ms_ is sorted.
  double Quantile(double part) const {
    return detect_ms_[static_cast<std::size_t>(std::ceil(part * frames())) - 1];
  }

  std::vector<double> detect_ms_;
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
  LandingPipelineOptions options = arguments.options.Read().landing;
  if (arguments.still) options.still = true;
  const std::unique_ptr<FrameSource> source = OpenSource(arguments.sources);
  const CameraCalibration calibration = FindCalibration(arguments, *source);
  const bool has_poses = !source->poses().empty();
  if (!calibration.body_from_camera && has_poses) {
    fmt::print(stderr, "kestrel: the calibration has no mount: no positions in the world\n");
  }
  LandingPipeline pipeline(calibration, options);
  pipeline.SetAltitude(arguments.altitude_m);
  const bool has_track = has_poses && calibration.body_from_camera && !options.still;
  LandingSink sink(arguments, *source, has_track);
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

// CLI11 takes "nan" for a number.
CLI::Validator InRange(double min, double max, const std::string& words) {
  return CLI::Validator(
      [=](const std::string& text) {
        const auto number = ParseNumber<double>(text);
        return number && *number > min && *number < max ? "" : "expected " + words;
      },
      "");
}

}  // namespace

void AddLandCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand("land", "Run the landing pipeline over a source");
  const auto arguments = std::make_shared<LandArguments>();
  command
      ->add_option("SOURCE", arguments->sources,
                   "A recording folder (EuRoC), a folder of images, image files, a video file, a "
                   "camera (/dev/video0) or a GStreamer pipeline")
      ->required();
  command
      ->add_option("--camera", arguments->camera,
                   "Calibration: EuRoC sensor.yaml, Kalibr camchain.yaml, ROS camera_info YAML or "
                   "OpenCV YAML; overrides the source's")
      ->type_name("FILE");
  arguments->options.AddTo(command);
  CLI::Option* output =
      command->add_option("--output", arguments->output, "Folder for the results (else stdout)")
          ->type_name("DIR");
  command
      ->add_flag("--annotate{video}", arguments->annotate,
                 "Also write the frames with what was found: a video, or --annotate=images")
      ->needs(output)
      ->check(CLI::IsMember({"video", "images"}));
  command->add_flag("--still", arguments->still, "The frames have nothing to do with each other");
  command
      ->add_option("--altitude", arguments->altitude_m,
                   "Height of the camera above the pattern (m), where the source has no poses")
      ->type_name("M")
      ->check(InRange(0, 1e5, "a positive height in m"));
  command
      ->add_option("--clock-offset", arguments->clock_offset,
                   "Seconds to add to an image's time to get the navigation's")
      ->type_name("S")
      ->check(InRange(-kMaxClockOffset, kMaxClockOffset, "seconds"));
  command
      ->add_option("--predict", arguments->predict_s,
                   "Also write where the target will be after these times (s), as 0.5,1.0")
      ->type_name("S,...")
      ->delimiter(',')
      ->needs(output)
      ->check(InRange(0, 60, "seconds, above 0 and below 60"));
  command->add_flag("--force", arguments->force, "Replace files that exist");
  command->callback([arguments] { RunLand(*arguments); });
}

}  // namespace kestrel
