// SPDX-License-Identifier: BSD-3-Clause
#include "hunt_score.h"

#include <array>
#include <filesystem>
#include <sstream>
#include <variant>

#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/io/recording/event_source.h"
#include "kestrel/io/recording/media/image_file.h"
#include "kestrel/io/recording/open_source.h"
#include "kestrel/io/recording/tables/object_csv.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

constexpr double kReadout_s = 0.025;  // scene.yaml, rolling_shutter_readout_s

struct AnnotatedDisc {
  Eigen::Vector2d center_px;
  std::string color;
};

// Columns file, u, v, radius_px, colour; the rest of a line is remarks, with commas in quotes.
std::vector<AnnotatedDisc> ReadAnnotations(const fs::path& path) {
  std::istringstream lines(ReadFile(path.string()));
  std::vector<AnnotatedDisc> discs;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::array<std::string, 5> cell;
    for (std::string& text : cell) std::getline(cells, text, ',');
    const auto u = ParseNumber<double>(cell[1]);
    const auto v = ParseNumber<double>(cell[2]);
    if (!u || !v) throw InputError(path.string() + ": expected numbers u and v in '" + line + "'");
    discs.push_back({{*u, *v}, cell[4]});
  }
  return discs;
}

void Count(bool is_right, DigitScore* score) {
  ++score->count;
  score->right += is_right;
}

void ScoreDigits(const HuntObservation& observation, const std::vector<TrueSighting>& sightings,
                 const TrueObjects& objects, HuntScore* score) {
  constexpr double kReach_px = 10;
  constexpr double kNear_m = 3;
  for (const TrueSighting& sighting : sightings) {
    if (sighting.time != observation.time || sighting.visible_fraction < 1) continue;
    for (const ObjectDetection& detection : observation.report.detections) {
      if (!detection.digits || !objects.at(sighting.id).digit ||
          (detection.center_px - sighting.center_px).norm() > kReach_px) {
        continue;
      }
      const int found = LikeliestDigit(*detection.digits).digit;
      const bool is_right = LooksAlike(found, *objects.at(sighting.id).digit);
      Count(is_right, &score->digits);
      if (detection.location->position.norm() <= kNear_m) Count(is_right, &score->near_digits);
    }
  }
}

}  // namespace

RealFrameScore ScoreRealFrame(const std::string& folder) {
  constexpr double kReach_px = 20;
  cv::Mat image = ReadImage((fs::path(folder) / "treasure.jpg").string(), PixelFormat::kBgr);
  cv::rectangle(image, cv::Rect(0, 0, 600, 270), cv::Scalar::all(255), cv::FILLED);
  const CameraModel camera({image.cols,
                            image.rows,
                            700,
                            700,
                            0.5 * image.cols,
                            0.5 * image.rows,
                            DistortionModel::kNone,
                            {}});
  const ObjectDetector detector(camera, DefaultObjectModel());
  ObjectWorkspace workspace;
  ObjectReport report;
  detector.Detect(image, {}, workspace, &report);
  RealFrameScore score;
  for (const AnnotatedDisc& annotated : ReadAnnotations(fs::path(folder) / "annotations.csv")) {
    RealDisc& disc = score.discs.emplace_back();
    disc.color = annotated.color;
    disc.center_error_px = kReach_px;
    for (const ObjectDetection& detection : report.detections) {
      const double error_px = (detection.center_px - annotated.center_px).norm();
      if (error_px >= disc.center_error_px) continue;
      disc.center_error_px = error_px;
      disc.found_as = detector.model().classes[detection.class_index].name;
    }
  }
  for (const ObjectDetection& detection : report.detections) {
    ++(detection.completeness == Completeness::kMerged ? score.merged : score.single);
  }
  return score;
}

HuntScore ScoreHunt(const std::string& folder, const ObjectModel& model) {
  const FlightTruth truth(folder);
  const fs::path root = truth.root();
  const std::string objects_file = (root / "objects0" / "objects.csv").string();
  const std::string sightings_file = (root / "objects0" / "data.csv").string();
  const std::string digits_file = (root / "objects0" / "digits.csv").string();
  TrueObjects objects = ParseTrueObjects(ReadFile(objects_file), objects_file);
  if (fs::exists(digits_file)) ParseTrueDigits(ReadFile(digits_file), digits_file, &objects);
  const auto sightings = ParseTrueSightings(ReadFile(sightings_file), sightings_file, objects);

  const auto source = OpenSource({folder}, PixelFormat::kBgr);
  CameraCalibration calibration = *source->calibration();
  calibration.clock_offset = DurationFromSeconds(truth.scene().clock_offset_s);
  calibration.body_from_camera->rotation =
      truth.scene().mount_error * calibration.body_from_camera->rotation;
  HuntPipelineOptions options;
  options.readout_s = kReadout_s;
  HuntPipeline pipeline(calibration, model, options);
  // As in flight, the poses up to the one after the last row are needed.
  const Duration lead = *calibration.clock_offset + DurationFromSeconds(kReadout_s / 2);
  RecordingEvents events(source.get(), source->poses(), lead);
  HuntScore score;
  std::string csv = ObjectCsvHeader();
  for (Event event = events.Next(); !std::holds_alternative<EndOfStream>(event);
       event = events.Next()) {
    if (const auto* pose = std::get_if<PoseSample>(&event)) pipeline.AddPose(*pose);
    const auto* frame = std::get_if<Frame>(&event);
    if (frame == nullptr) continue;
    const HuntObservation& observation = pipeline.Process(frame->image, frame->time);
    csv += ObjectCsvRows(frame->name, observation, pipeline.detector().model());
    ScoreDigits(observation, sightings, objects, &score);
  }
  const std::string name = "object_detections.csv";
  score.comparisons = CompareObjects(truth, objects, sightings, ParseObjectRows(csv, name), name);
  for (const ObjectComparison& c : score.comparisons) {
    if (!c.IsObject() || !c.IsDetected()) continue;
    const std::string kind = c.is_wanted ? c.true_shape + ", wanted" : "cut off, hidden or small";
    score.center_errors_px[kind].push_back(c.center_error_px);
    if (c.is_wanted) score.center_errors_px["all, wanted"].push_back(c.center_error_px);
  }
  return score;
}

}  // namespace kestrel
