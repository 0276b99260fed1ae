// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/hunt_task.h"

#include <array>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/flight/session/result_files.h"
#include "kestrel/flight/session/task.h"
#include "kestrel/io/recording/overlays/object_overlay.h"
#include "kestrel/io/recording/tables/object_map_files.h"
#include "kestrel/vision/pipeline/ground_height.h"
#include "kestrel/vision/pipeline/require_altitude.h"
#include "kestrel/vision/pipeline/sought_object.h"

namespace kestrel {
namespace {

// Returns nothing for an image without any contrast, which says nothing of the camera.
std::optional<bool> IsColored(const cv::Mat& image) {
  cv::Mat channels[3];
  cv::split(image, channels);
  if (cv::norm(channels[0], channels[1], cv::NORM_INF) > 0 ||
      cv::norm(channels[1], channels[2], cv::NORM_INF) > 0) {
    return true;
  }
  double low = 0, high = 0;
  cv::minMaxLoc(channels[0], &low, &high);
  return low == high ? std::nullopt : std::optional(false);
}

// Writes the results of a hunt: detections, annotated frames and finally the map, which never goes
// to stdout. Waits for the disk. Throws InputError when it cannot write.
class HuntFiles : public ObservationSink {
 public:
  // 'pipeline': the one that gives the observations; outlives this. 'has_map': objects have places
  // in the world. 'origin': latitude and longitude (degrees) of the world's origin, or empty.
  HuntFiles(const OutputOptions& output, const HuntPipeline* pipeline, bool has_map,
            const std::vector<double>& origin)
      : pipeline_(pipeline),
        model_(pipeline->detector().model()),
        only_in_image_(output.only_in_image),
        results_(output, kObjectTable, ObjectCsvHeader()),
        has_map_(has_map),
        origin_(origin) {}

  void Take(const Observation& observation) override {
    const Frame& frame = observation.frame;
    HuntObservation seen = std::get<HuntObservation>(observation.seen);
    if (only_in_image_) {
      for (ObjectDetection& detection : seen.report.detections) detection.location.reset();
    }
    results_.WriteRows(ObjectCsvRows(frame.name, seen, model_));
    if (!results_.wants_pictures()) return;
    results_.WritePicture(
        frame.name, DrawObjectOverlay(frame.image, model_, seen, pipeline_->map().Confirmed()));
  }
  void Take(const BrokenFrame& frame) override {
    HuntObservation nothing;
    nothing.time = frame.time;
    results_.WriteRows(ObjectCsvRows(frame.name, nothing, model_));
  }
  void Finish() override {
    if (has_map_ && results_.folder()) WriteObjectMap(*pipeline_, origin_, *results_.folder());
  }

 private:
  const HuntPipeline* pipeline_;
  ObjectModel model_;  // the pipeline's may change in flight, while rows are written
  bool only_in_image_;
  ResultFiles results_;
  bool has_map_;
  std::vector<double> origin_;
};

// The pipeline of coloured objects in a session.
class HuntVision : public Vision {
 public:
  // 'origin': latitude and longitude (degrees) of the world's origin, for the map; or empty. 'go':
  // as of HuntTask. Throws InputError when camera, model or options are not valid, or the model has
  // no such class.
  HuntVision(const SessionCamera& camera, const ObjectModel& model, const ColorGrid& grid,
             const HuntPipelineOptions& options, std::vector<double> origin, const std::string& go);

  void AddPose(const PoseSample& pose) override { pipeline_.AddPose(pose); }
  void AddGimbal(const GimbalSample& sample) override { pipeline_.AddGimbal(sample); }
  Duration pose_lead() const override;
  Observation Process(const Frame& frame) override;
  TrackSnapshot snapshot() const override { return snapshot_; }
  bool seeks_object() const override { return pipeline_.sought() != nullptr; }
  void Assign(const AssignedObject& object) override { pipeline_.Assign(object); }
  void Leave(int number) override { pipeline_.Leave(number); }
  const ObjectMap* map() const override { return &pipeline_.map(); }
  bool has_world() const override { return has_world_ && !pipeline_.options().still; }
  void SetGroundZero(double height_m) override { pipeline_.SetGroundZero(height_m); }
  void Change(const TaskOptions& options, std::optional<double> altitude_m) override;
  std::unique_ptr<ObservationSink> MakeTables(const OutputOptions& output) const override;
  ObservationPainter MakePainter() const override;

  // Reports how the objects' sizes contradict the given height of the ground; not in flight.
  std::string Warning() const override;
  std::string Found() const override;
  // Number of segments left after each step, as in the paper's Table 3.
  std::string Remarks() const override;

 private:
  void RequireColor(const Frame& frame);
  void ShowSought(Time time);

  HuntPipeline pipeline_;
  Duration clock_offset_;
  std::optional<double> altitude_m_;
  bool has_world_, is_live_;
  std::vector<double> origin_;
  TrackSnapshot snapshot_;
  bool has_pose_ = false;    // the last frame had one
  bool is_colored_ = false;  // an image in colour has been seen
  std::size_t detections_ = 0;
  std::array<std::size_t, kObjectStageCount> passed_{};
};

HuntVision::HuntVision(const SessionCamera& camera, const ObjectModel& model, const ColorGrid& grid,
                       const HuntPipelineOptions& options, std::vector<double> origin,
                       const std::string& go)
    : pipeline_(camera.calibration, model, grid, InFlight(options, camera.is_live)),
      clock_offset_(camera.calibration.clock_offset.value_or(Duration::zero())),
      altitude_m_(camera.altitude_m),
      has_world_(camera.has_world),
      is_live_(camera.is_live),
      origin_(std::move(origin)) {
  RequireAltitude(altitude_m_);
  pipeline_.SetAltitude(altitude_m_);
  if (!go.empty()) pipeline_.Seek(go);
}

// The last row of a rolling shutter is exposed later than the frame's time.
Duration HuntVision::pose_lead() const {
  return clock_offset_ + DurationFromSeconds(pipeline_.options().readout_s / 2);
}

Observation HuntVision::Process(const Frame& frame) {
  if (!is_live_ && !is_colored_) RequireColor(frame);
  const HuntObservation& seen = pipeline_.Process(frame.image, frame.time);
  snapshot_.captured = frame.time + clock_offset_;
  snapshot_.detect_time = seen.detect_time;
  ++snapshot_.frames;
  snapshot_.detections += !seen.report.detections.empty();
  detections_ += seen.report.detections.size();
  for (std::size_t i = 0; i < kObjectStageCount; ++i) passed_[i] += seen.report.passed[i];
  has_pose_ = seen.world_from_camera.has_value();
  ShowSought(frame.time);
  return {frame, seen};
}

// To guidance; nothing where no object is sought.
void HuntVision::ShowSought(Time time) {
  const SoughtObject* sought = pipeline_.sought();
  if (sought == nullptr) return;
  snapshot_.mark = sought->number();
  snapshot_.state = sought->StateAt(time);
  snapshot_.target = sought->At(time);
  snapshot_.seen = sought->seen();
  if (snapshot_.seen) *snapshot_.seen += clock_offset_;
}

void HuntVision::RequireColor(const Frame& frame) {
  const std::optional<bool> colored = IsColored(frame.image);
  if (colored == false) {
    throw InputError(frame.name + ": is a gray image, expected images in colour to hunt in");
  }
  is_colored_ = colored.has_value();
}

void HuntVision::Change(const TaskOptions& options, std::optional<double> altitude_m) {
  pipeline_.ChangeOptions(InFlight(options.hunt, is_live_));
  pipeline_.SetAltitude(altitude_m);
  altitude_m_ = altitude_m;
}

std::unique_ptr<ObservationSink> HuntVision::MakeTables(const OutputOptions& output) const {
  return std::make_unique<HuntFiles>(output, &pipeline_, has_world(), origin_);
}

ObservationPainter HuntVision::MakePainter() const {
  return [model = pipeline_.detector().model()](const Observation& observation) {
    return DrawObjectOverlay(observation.frame.image, model,
                             std::get<HuntObservation>(observation.seen));
  };
}

std::string HuntVision::Warning() const {
  if (is_live_) return "";
  const std::optional<GroundHeight> higher = pipeline_.ground_contradiction();
  if (!higher) return "";
  if (!has_pose_) {
    return fmt::format(
        "by the size of the objects the camera is {0:.2f} m above the ground (standard deviation "
        "{1:.2f} m), --altitude says {2:g} m: set --altitude {0:.2f}",
        *altitude_m_ - higher->height_m, higher->sigma_m, *altitude_m_);
  }
  const double ground_m = pipeline_.options().ground_height_m;
  return fmt::format(
      "by the size of the objects the ground is at z = {0:.2f} m of the navigation's world "
      "(standard deviation {1:.2f} m), hunt.ground_height_m says {2:g} m: set "
      "hunt.ground_height_m={0:.2f}, or correct the navigation's z, its clock or the camera's "
      "mount",
      ground_m + higher->height_m, higher->sigma_m, ground_m);
}

std::string HuntVision::Found() const {
  std::string found = fmt::format("{} detections", detections_);
  if (is_live_) found += fmt::format(", {} objects in the map", pipeline_.map().Confirmed().size());
  return found;
}

std::string HuntVision::Remarks() const {
  std::string remarks = "segments";
  for (std::size_t i = 0; i < kObjectStageCount; ++i) {
    remarks += fmt::format("{} {} {}", i == 0 ? "" : ",", passed_[i],
                           ToString(static_cast<ObjectStage>(i)));
  }
  return remarks + "\n";
}

}  // namespace

HuntTask::HuntTask(HuntPipelineOptions options, ObjectModel model, std::optional<ColorGrid> grid,
                   std::vector<double> origin, std::string go)
    : options_(std::move(options)),
      model_(std::move(model)),
      grid_(grid ? *std::move(grid) : ColorGrid(model_.colors)),
      origin_(std::move(origin)),
      go_(std::move(go)) {}

std::unique_ptr<Vision> HuntTask::MakeVision(const SessionCamera& camera) const {
  return std::make_unique<HuntVision>(camera, model_, grid_, options_, origin_, go_);
}

}  // namespace kestrel
