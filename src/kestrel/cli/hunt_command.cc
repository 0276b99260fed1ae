// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/cli/hunt_command.h"

#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/base/write_file.h"
#include "kestrel/cli/interrupt.h"
#include "kestrel/cli/progress_bar.h"
#include "kestrel/cli/source_arguments.h"
#include "kestrel/mapping/map_file.h"
#include "kestrel/pipeline/hunt_pipeline.h"
#include "kestrel/pipeline/pose_feeder.h"
#include "kestrel/recording/annotated_writer.h"
#include "kestrel/recording/map_inset.h"
#include "kestrel/recording/object_csv.h"
#include "kestrel/recording/object_map_csv.h"
#include "kestrel/recording/object_overlay.h"
#include "kestrel/recording/open_source.h"
#include "kestrel/recording/output_folder.h"

namespace kestrel {
namespace {

struct HuntArguments {
  SourceArguments source;
  std::string model;
  std::string grid;
  std::vector<double> origin;  // latitude, longitude, degrees; or empty
};

// Where the results go: files below --output, or the detections to stdout.
class HuntSink {
 public:
  HuntSink(const HuntArguments& hunt, double rate_hz) : origin_(hunt.origin) {
    const SourceArguments& arguments = hunt.source;
    if (!arguments.output.empty()) {
      folder_.emplace(arguments.output, arguments.force);
      file_ = folder_->OpenText(kDetections);
    }
    if (arguments.annotate == "images") annotated_ = MakeImageWriter(*folder_);
    if (arguments.annotate == "video") annotated_ = MakeVideoWriter(*folder_, rate_hz);
    WriteAtOnce(ObjectCsvHeader(), kDetections, &csv());
  }

  void Write(const Frame& frame, const HuntObservation& observation, const HuntPipeline& pipeline) {
    const ObjectModel& model = pipeline.detector().model();
    WriteAtOnce(ObjectCsvRows(frame.name, observation, model), kDetections, &csv());
    if (!annotated_) return;
    cv::Mat drawn = DrawObjectOverlay(frame.image, model, observation);
    if (const auto& pose = observation.world_from_camera) {
      DrawMapInset(pipeline.map().Confirmed(), model, pose->translation.head<2>(), &drawn);
    }
    annotated_->Write(frame.name, drawn);
  }

  // The map goes to files only.
  void WriteMap(const ObjectMap& map, const ObjectModel& model) const {
    if (!folder_) return;
    const std::vector<MappedObject> objects = map.Confirmed();
    WriteFile(folder_->NewFile("object_map.csv").string(), ObjectMapCsv(objects, model));
    WriteFile(folder_->NewFile("object_map.json").string(), PrintObjects(objects));
    if (origin_.empty()) return;
    WriteFile(folder_->NewFile("object_map.geojson").string(),
              PrintGeoJson(objects, model, {origin_[0], origin_[1]}));
  }

 private:
  static constexpr char kDetections[] = "object_detections.csv";

  std::ostream& csv() { return file_.is_open() ? file_ : std::cout; }

  std::vector<double> origin_;
  std::optional<OutputFolder> folder_;
  std::ofstream file_;
  std::unique_ptr<AnnotatedWriter> annotated_;
};

class Summary {
 public:
  void Add(const HuntObservation& observation) {
    times_.Add(observation.detect_time);
    detections_ += observation.report.detections.size();
    for (std::size_t i = 0; i < kObjectStageCount; ++i) passed_[i] += observation.report.passed[i];
  }
  std::size_t frames() const { return times_.frames(); }

  // The last line is the paper's Table 3: segments that are left after each step.
  void Print() const {
    fmt::print(stderr, "{} frames, {} detections{}\nsegments", frames(), detections_,
               times_.Summary());
    for (std::size_t i = 0; i < kObjectStageCount; ++i) {
      fmt::print(stderr, "{} {} {}", i == 0 ? "" : ",", passed_[i],
                 ToString(static_cast<ObjectStage>(i)));
    }
    fmt::print(stderr, "\n");
  }

 private:
  DetectTimes times_;
  std::size_t detections_ = 0;
  std::array<std::size_t, kObjectStageCount> passed_{};
};

// Says once what the objects say of the ground, where that contradicts what is told.
class GroundWarning {
 public:
  explicit GroundWarning(std::optional<double> altitude_m) : altitude_m_(altitude_m) {}

  void Check(const HuntPipeline& pipeline, const HuntObservation& observation,
             const ProgressBar& progress) {
    const std::optional<GroundHeight> higher = pipeline.ground_contradiction();
    if (was_said_ || !higher) return;
    was_said_ = true;
    if (!observation.world_from_camera) {
      const double height_m = *altitude_m_ - higher->height_m;
      progress.Say(fmt::format(
          "by the size of the objects the camera is {0:.2f} m above the ground (standard "
          "deviation {1:.2f} m), --altitude says {2:g} m: set --altitude {0:.2f}",
          height_m, higher->sigma_m, *altitude_m_));
      return;
    }
    const double ground_m = pipeline.options().ground_height_m;
    progress.Say(fmt::format(
        "by the size of the objects the ground is at z = {0:.2f} m of the navigation's world "
        "(standard deviation {1:.2f} m), hunt.ground_height_m says {2:g} m: set "
        "hunt.ground_height_m={0:.2f}, or correct the navigation's z, its clock or the camera's "
        "mount",
        ground_m + higher->height_m, higher->sigma_m, ground_m));
  }

 private:
  std::optional<double> altitude_m_;
  bool was_said_ = false;
};

void ProcessFrames(FrameSource* source, const CameraCalibration& calibration,
                   HuntPipeline* pipeline, HuntSink* sink, GroundWarning* ground,
                   Summary* summary) {
  // The last row of a rolling shutter is later than the image.
  const Duration lead = calibration.clock_offset.value_or(Duration::zero()) +
                        DurationFromSeconds(pipeline->options().readout_s / 2);
  PoseFeeder poses(source->poses());
  ProgressBar progress(source->frame_count());
  Frame frame;
  while (!WasInterrupted() && source->Next(&frame)) {
    RequireSize(frame, calibration.intrinsics);
    poses.FeedUntil(frame.time + lead, pipeline);
    const HuntObservation& observation = pipeline->Process(frame.image, frame.time);
    sink->Write(frame, observation, *pipeline);
    ground->Check(*pipeline, observation, progress);
    summary->Add(observation);
    progress.Show(summary->frames());
  }
}

void RunHunt(const HuntArguments& arguments) {
  HuntPipelineOptions options = arguments.source.options.Read().hunt;
  if (arguments.source.still) options.still = true;
  const ObjectModel model =
      arguments.model.empty() ? DefaultObjectModel() : ReadObjectModel(arguments.model);
  const ColorGrid grid = arguments.grid.empty()
                             ? ColorGrid(model.colors)
                             : ColorGrid::Load(arguments.grid, model.colors.colors.size());
  const std::unique_ptr<FrameSource> source =
      OpenSource(arguments.source.sources, PixelFormat::kBgr);
  const CameraCalibration calibration = arguments.source.FindCalibration(*source);
  HuntPipeline pipeline(calibration, model, grid, options);
  pipeline.SetAltitude(arguments.source.altitude_m);
  HuntSink sink(arguments, source->rate_hz());
  GroundWarning ground(arguments.source.altitude_m);
  Summary summary;
  CatchInterrupts();
  try {
    ProcessFrames(source.get(), calibration, &pipeline, &sink, &ground, &summary);
  } catch (const InputError&) {
    if (summary.frames() > 0) summary.Print();  // these stay
    throw;
  }
  if (!options.still && !source->poses().empty() && calibration.body_from_camera) {
    sink.WriteMap(pipeline.map(), model);
  }
  summary.Print();
}

}  // namespace

void AddHuntCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand("hunt", "Run the coloured-object pipeline over a source");
  const auto arguments = std::make_shared<HuntArguments>();
  arguments->source.AddTo(command);
  command
      ->add_option("--model", arguments->model,
                   "Objects and their colours (YAML) in place of the built-in ones")
      ->type_name("FILE");
  command
      ->add_option("--grid", arguments->grid,
                   "Color grid (64^3 bytes) in place of the one that the model gives")
      ->type_name("FILE");
  command
      ->add_option("--origin", arguments->origin,
                   "Latitude and longitude (degrees) of the world's origin, as 50.1,14.4: also "
                   "write the map as GeoJSON")
      ->type_name("LAT,LON")
      ->delimiter(',')
      ->expected(2)
      ->check(InRange(-180.0001, 180.0001, "degrees"));
  command->callback([arguments] { RunHunt(*arguments); });
}

}  // namespace kestrel
