// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/cli/console_command.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/base/options.h"
#include "kestrel/base/read_file.h"
#include "kestrel/cli/console_calibration.h"
#include "kestrel/cli/frame_winder.h"
#include "kestrel/cli/interrupt.h"
#include "kestrel/cli/land_result.h"
#include "kestrel/cli/pipeline_run.h"
#include "kestrel/cli/source_arguments.h"
#include "kestrel/console/replay_console.h"
#include "kestrel/evaluation/landing_comparison.h"
#include "kestrel/objects/object_model.h"
#include "kestrel/pipeline/camera_poses.h"
#include "kestrel/pipeline/landing_pipeline.h"
#include "kestrel/recording/euroc_recording.h"
#include "kestrel/recording/event_source.h"
#include "kestrel/recording/landing_csv.h"
#include "kestrel/recording/open_source.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

struct ConsoleArguments {
  SourceArguments source;
  std::string address;
  std::string model;
  std::string output = "taught";  // for what the page saves
  // Of `kestrel land`, which is shown instead of being found again; none where it is empty.
  std::string result;

  ConsoleOptions Options(const KestrelOptions& options) const {
    if (address.empty()) return options.console;
    return Checked(WithAddress(options.console, address, "--address"));
  }
};

// The truth of a recording, where it has one.
struct Truth {
  std::string recording;
  std::string pattern_file;
};

std::optional<Truth> FindTruth(const std::vector<std::string>& sources) {
  if (sources.size() != 1) return std::nullopt;
  const auto root = FindEurocRoot(sources.front());
  if (!root) return std::nullopt;
  const fs::path pattern = fs::path(*root) / "landing_pattern0" / "data.csv";
  const fs::path poses = fs::path(*root) / "state_groundtruth_estimate0" / "data.csv";
  if (!fs::exists(pattern) || !fs::exists(poses)) return std::nullopt;
  return Truth{sources.front(), pattern.string()};
}

FrameMark MarkOf(const LandingComparison& comparison) {
  switch (comparison.verdict) {
    case LandingVerdict::kFound:
      return FrameMark::kFound;
    case LandingVerdict::kFalse:
      return FrameMark::kFalse;
    case LandingVerdict::kMissed:
      return comparison.IsVisible() ? FrameMark::kLost : FrameMark::kNothing;
    case LandingVerdict::kQuiet:
      break;
  }
  return FrameMark::kNothing;
}

// The landing pipeline over a recording, or what it found before, kept for the page.
class ReplayRun : public PipelineRun {
 public:
  // 'console': is told how far the run is; null: nobody is. 'result': the table of what was found
  // before; empty: it is found now.
  ReplayRun(const OpenedSource& opened, const LandingPipelineOptions& options,
            std::optional<double> altitude_m, ReplayConsole* console,
            const std::string& result = "")
      : pipeline_(opened.calibration, options),
        view_(ViewOf(opened.calibration, options)),
        frame_count_(opened.source->frame_count().value_or(0)),
        console_(console),
        poses_(opened.calibration, static_cast<std::size_t>(options.pose_capacity),
               DurationFromSeconds(options.pose_gap_s), Duration::zero(), {}),
        table_(LandingCsvHeader()) {
    pipeline_.SetAltitude(altitude_m);
    if (!result.empty()) result_.emplace(result);
  }

  void AddPose(const PoseSample& pose) override {
    if (result_) {
      poses_.Add(pose);
    } else {
      pipeline_.AddPose(pose);
    }
  }

  Duration Process(const Frame& frame) override {
    ReplayFrame& replayed = frames_.emplace_back();
    replayed.observation =
        result_ ? FromResult(frame.time) : pipeline_.Process(frame.image, frame.time);
    found_ += replayed.observation.report.detection.has_value();
    table_ += LandingCsvRow(frame.name, replayed.observation);
    if (console_ != nullptr && frames_.size() % kProgressFrames == 0) {
      console_->SetProgress(fmt::format("{} of {} frames", frames_.size(), frame_count_));
    }
    return replayed.observation.detect_time;
  }

  std::string Found() const override { return fmt::format("pattern found in {}", found_); }
  std::string Remarks() const override { return ""; }

  std::size_t done() const { return frames_.size(); }

  // Once only: all frames with their marks.
  ReplayResult TakeResult(const std::optional<Truth>& truth) {
    if (result_) {
      result_->RequireEnd();
      table_ = result_->text();
    }
    if (truth) {
      MarkByTruth(*truth);
    } else {
      MarkByTrack(&frames_);
    }
    return {view_, std::move(frames_), std::move(table_)};
  }

 private:
  static constexpr std::size_t kProgressFrames = 20;

  LandingObservation FromResult(Time time) {
    const auto camera = poses_.At(time);
    return result_->Next(time, camera ? std::optional(camera->world_from_camera) : std::nullopt);
  }

  void MarkByTruth(const Truth& truth) {
    const auto patterns = ParseTruePatterns(ReadFile(truth.pattern_file), truth.pattern_file);
    const std::string name = "landing_detections.csv";
    const auto comparisons = CompareLanding(FlightTruth(truth.recording), patterns,
                                            ParseDetectionRows(table_, name), name);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      frames_[i].mark = MarkOf(comparisons[i]);
      if (comparisons[i].errors) frames_[i].error_px = comparisons[i].errors->center_px;
    }
  }

  LandingPipeline pipeline_;
  LandingView view_;
  std::size_t frame_count_;
  ReplayConsole* console_;
  std::optional<LandResult> result_;
  CameraPoses poses_;  // for the result
  std::vector<ReplayFrame> frames_;
  std::string table_;  // as `kestrel land` writes it
  std::size_t found_ = 0;
};

// The recording once more with other options; nothing when it is to end before.
std::optional<ReplayResult> DetectAgain(const ConsoleArguments& arguments,
                                        const LandingPipelineOptions& options,
                                        const std::optional<Truth>& truth,
                                        const SecondRun::GoOn& go_on) {
  const OpenedSource opened = arguments.source.Open(PixelFormat::kGray);
  ReplayRun run(opened, options, arguments.source.altitude_m, /*console=*/nullptr);
  RecordingEvents events(opened.source.get(), opened.source->poses(),
                         opened.calibration.clock_offset.value_or(Duration::zero()));
  while (go_on(run.done())) {
    const Event event = events.Next();
    if (std::holds_alternative<EndOfStream>(event)) {
      return run.TakeResult(truth);
    }
    if (const auto* pose = std::get_if<PoseSample>(&event)) run.AddPose(*pose);
    if (const auto* frame = std::get_if<Frame>(&event)) run.Process(*frame);
  }
  return std::nullopt;
}

// A gray camera's images have three equal channels, if any.
bool HasColor(const cv::Mat& bgr) {
  constexpr double kMinDifference = 16;
  std::vector<cv::Mat> channels;
  cv::split(bgr, channels);
  return cv::norm(channels[0], channels[1], cv::NORM_INF) > kMinDifference ||
         cv::norm(channels[0], channels[2], cv::NORM_INF) > kMinDifference;
}

// The one that is given, or saved the last time.
ObjectModel FirstModel(const ConsoleArguments& arguments) {
  if (!arguments.model.empty()) return ReadObjectModel(arguments.model);
  const std::string saved = (fs::path(arguments.output) / "objects.yaml").string();
  return fs::exists(saved) ? ReadObjectModel(saved) : DefaultObjectModel();
}

// What the page teaches colours by; nothing when the recording is gray.
std::optional<ColorSource> FindColors(const ConsoleArguments& arguments) {
  const std::vector<std::string>& sources = arguments.source.sources;
  const std::shared_ptr<FrameSource> source = arguments.source.bag.Open(sources, PixelFormat::kBgr);
  Frame first;
  if (!source->Read(0, &first) || !HasColor(first.image)) {
    if (arguments.model.empty()) return std::nullopt;
    throw InputError("--model: " + sources.front() + " has no images in color to teach it by");
  }
  const auto read = [source](std::size_t index) {
    Frame frame;
    source->Read(index, &frame);
    return frame.image;
  };
  std::vector<std::string> names;
  for (const std::string& name : sources) {
    // As a folder with a slash behind its name.
    names.push_back((fs::absolute(name) / "").lexically_normal().parent_path().string());
  }
  return ColorSource{fmt::format("{}", fmt::join(names, " ")), source->frame_count().value_or(1),
                     read, FirstModel(arguments), arguments.output};
}

void RequireEnd(const std::vector<std::string>& sources) {
  for (const std::string& source : sources) {
    if (!IsCamera(source)) continue;
    throw InputError(source +
                     ": the page goes to and fro, expected a recording, a bag, images or a video; "
                     "`kestrel fly --console` shows a camera");
  }
}

void RunConsole(const ConsoleArguments& arguments) {
  const KestrelOptions all_options = arguments.source.options.Read();
  LandingPipelineOptions options = all_options.landing;
  options.still = options.still || arguments.source.still;
  RequireEnd(arguments.source.sources);
  const OpenedSource opened = arguments.source.Open(PixelFormat::kGray);
  const std::string& name = arguments.source.sources.front();
  const std::optional<Truth> truth = FindTruth(arguments.source.sources);
  std::optional<ColorSource> colors = FindColors(arguments);
  const bool has_colors = colors.has_value();
  ReplayConsole console(arguments.Options(all_options), name, options, truth.has_value(),
                        std::move(colors));
  fmt::print(stderr, "console: {}\n", console.url());
  if (has_colors) fmt::print(stderr, "colors that are taught: {}\n", arguments.output);
  ReplayRun run(opened, options, arguments.source.altitude_m, &console, arguments.result);
  RunPipeline(opened, &run);
  if (WasInterrupted()) return;
  if (run.done() == 0) throw InputError(name + ": has no images to show");
  FrameWinder winder([&] { return arguments.source.bag.Open(arguments.source.sources); });
  const auto read = [&winder](std::size_t index) { return winder.Read(index); };
  const auto detect = [&](const LandingPipelineOptions& other, const SecondRun::GoOn& go_on) {
    return DetectAgain(arguments, other, truth, go_on);
  };
  console.OfferCalibration(CalibrationTools(arguments.source, options, arguments.output));
  console.Play(run.TakeResult(truth), read, detect, WasInterrupted);
}

}  // namespace

void AddConsoleCommand(CLI::App* app) {
  CLI::App* command =
      app->add_subcommand("console", "The web page on a recording: replay it, teach its colors");
  const auto arguments = std::make_shared<ConsoleArguments>();
  arguments->source.AddReadingTo(command);
  command
      ->add_option("--address", arguments->address,
                   "Where the page is served (127.0.0.1:8080); port 0: any free one")
      ->type_name("ADDRESS:PORT");
  command
      ->add_option("--model", arguments->model,
                   "Objects (YAML) whose colours the page teaches, in place of those saved before "
                   "or the built-in ones")
      ->type_name("FILE");
  command
      ->add_option("--output", arguments->output,
                   "Folder for what the page saves: calibrations, and the model that it teaches "
                   "(objects.yaml), its versions and the draft (taught)")
      ->type_name("DIR");
  command->callback([arguments] {
    arguments->result = TakeLandResult(&arguments->source.sources).value_or("");
    RunConsole(*arguments);
  });
}

}  // namespace kestrel
