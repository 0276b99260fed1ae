// SPDX-License-Identifier: BSD-3-Clause
// Prints how well coloured objects are found: on the real frame, and on the independently rendered
// flights, whose clock offset is given to the pipeline as a calibration would.
#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/base/error.h"
#include "kestrel/base/parse_number.h"
#include "kestrel/base/read_file.h"
#include "kestrel/camera/calibration_reader.h"
#include "kestrel/evaluation/object_comparison.h"
#include "kestrel/evaluation/object_tables.h"
#include "kestrel/pipeline/hunt_pipeline.h"
#include "kestrel/recording/csv_table.h"
#include "kestrel/recording/image_file.h"
#include "kestrel/recording/object_csv.h"
#include "kestrel/recording/open_source.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

struct Flight {
  std::string folder;
  double clock_offset_s;  // scene.yaml, time_offset_s
};
constexpr double kReadout_s = 0.025;  // scene.yaml, camera.rolling_shutter_readout_s

struct AnnotatedDisc {
  Eigen::Vector2d center_px;
  std::string color;
};

// Columns file, u, v, radius_px, colour; what follows is remarks, with commas in quotes.
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

// The screenshot has no calibration; its plot and legend are no part of the camera's image.
void PrintReal(const fs::path& folder) {
  constexpr double kReach_px = 20;
  cv::Mat image = ReadImage((folder / "treasure.jpg").string(), PixelFormat::kBgr);
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
  fmt::print("\n## hunt_real\n\n| annotated | found as | centre, px |\n|---|---|---|\n");
  for (const AnnotatedDisc& disc : ReadAnnotations(folder / "annotations.csv")) {
    const Eigen::Vector2d& truth = disc.center_px;
    const auto nearest =
        std::min_element(report.detections.begin(), report.detections.end(),
                         [&](const ObjectDetection& a, const ObjectDetection& b) {
                           return (a.center_px - truth).norm() < (b.center_px - truth).norm();
                         });
    const bool is_found =
        nearest != report.detections.end() && (nearest->center_px - truth).norm() < kReach_px;
    fmt::print("| {} | {} | {} |\n", disc.color,
               is_found ? detector.model().classes[nearest->class_index].name : "-",
               is_found ? fmt::format("{:.2f}", (nearest->center_px - truth).norm()) : "-");
  }
  const auto merged = std::count_if(report.detections.begin(), report.detections.end(),
                                    [](const ObjectDetection& detection) {
                                      return detection.completeness == Completeness::kMerged;
                                    });
  fmt::print("\n{} detections in all, and {} that may be several discs\n",
             report.detections.size() - merged, merged);
}

// Digits that are right; a 6 that is upside down is a 9.
struct DigitScore {
  int right = 0;
  int count = 0;
};

// Digits of cuboids by their ids.
std::map<int, int> ReadDigits(const fs::path& root) {
  const fs::path path = root / "objects0" / "digits.csv";
  std::map<int, int> digits;
  if (!fs::exists(path)) return digits;
  const std::string text = ReadFile(path.string());
  const CsvTable table(text, path.string());
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    digits[static_cast<int>(table.Integer(row, table.Column("id []")))] =
        static_cast<int>(table.Integer(row, table.Column("digit []")));
  }
  return digits;
}

void ScoreDigits(const HuntObservation& observation, const std::vector<TrueSighting>& sightings,
                 const std::map<int, int>& digits, DigitScore* score) {
  const auto without_up = [](int digit) { return digit == 9 ? 6 : digit; };
  for (const TrueSighting& sighting : sightings) {
    if (sighting.time != observation.time || sighting.visible_fraction < 1) continue;
    for (const ObjectDetection& detection : observation.report.detections) {
      if (!detection.digits || (detection.center_px - sighting.center_px).norm() > 10) continue;
      const auto best = std::max_element(detection.digits->begin(), detection.digits->end());
      const int found = static_cast<int>(best - detection.digits->begin());
      ++score->count;
      score->right += without_up(found) == without_up(digits.at(sighting.id));
    }
  }
}

void PrintFlight(const fs::path& folder, double clock_offset_s) {
  const FlightTruth truth(folder.string());
  const fs::path root = truth.root();
  const std::string objects_file = (root / "objects0" / "objects.csv").string();
  const std::string sightings_file = (root / "objects0" / "data.csv").string();
  const TrueObjects objects = ParseTrueObjects(ReadFile(objects_file), objects_file);
  const auto sightings = ParseTrueSightings(ReadFile(sightings_file), sightings_file, objects);
  const std::map<int, int> digits = ReadDigits(root);

  const auto source = OpenSource({folder.string()}, PixelFormat::kBgr);
  CameraCalibration calibration = ReadCalibration(source->calibration_file());
  calibration.clock_offset = DurationFromSeconds(clock_offset_s);
  HuntPipelineOptions options;
  options.readout_s = kReadout_s;
  options.pose_capacity = 100000;
  HuntPipeline pipeline(calibration, DefaultObjectModel(), options);
  for (const PoseSample& pose : source->poses()) pipeline.AddPose(pose);
  std::string csv = ObjectCsvHeader();
  DigitScore digit_score;
  for (Frame frame; source->Next(&frame);) {
    const HuntObservation& observation = pipeline.Process(frame.image, frame.time);
    csv += ObjectCsvRows(frame.name, observation, pipeline.detector().model());
    if (!digits.empty()) ScoreDigits(observation, sightings, digits, &digit_score);
  }
  const std::string name = "object_detections.csv";
  const auto comparisons =
      CompareObjects(truth, objects, sightings, ParseObjectRows(csv, name), name);
  fmt::print("\n# {}\n\n{}", folder.filename().string(), ToMarkdown(DetectionTable(comparisons)));
  if (digit_score.count > 0) {
    fmt::print("\n{} of {} digits right (6 and 9 as one)\n", digit_score.right, digit_score.count);
  }
}

void Run(const fs::path& data) {
  if (fs::exists(data / "hunt_real")) PrintReal(data / "hunt_real");
  for (const Flight& flight :
       {Flight{"discs", 0.07087441493809551}, Flight{"cuboids", 0.1655976076253778}}) {
    const fs::path folder = data / "hunt_hard" / flight.folder;
    if (fs::exists(folder)) PrintFlight(folder, flight.clock_offset_s);
  }
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("Accuracy of the coloured-object pipeline");
  std::string data = KESTREL_DATA_DIR;
  app.add_option("--data", data, "Folder with hunt_real and hunt_hard");
  CLI11_PARSE(app, argc, argv);
  try {
    kestrel::Run(data);
  } catch (const kestrel::InputError& error) {
    fmt::print(stderr, "hunt_accuracy: {}\n", error.what());
    return 1;
  }
  return 0;
}
