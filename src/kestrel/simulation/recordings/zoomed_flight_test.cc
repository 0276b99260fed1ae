// SPDX-License-Identifier: BSD-3-Clause
// The landing pipeline on rendered flights with a lens that zooms.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "kestrel/core/base/load_yaml.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"
#include "kestrel/io/recording/tables/csv_table.h"
#include "kestrel/simulation/recordings/recording_plan.h"
#include "kestrel/simulation/recordings/test_plans.h"
#include "kestrel/simulation/vehicle/flight_time.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {
namespace {

using Settings = std::vector<std::string>;

struct Seen {
  double time_s;
  bool is_zooming;
  double error_m;  // distance from the true place in the world; NaN where the pad was not found
};

// Places of the pattern in the world by the times of the images (ns).
std::map<std::int64_t, Eigen::Vector3d> TruePlaces(const RecordingPlan& plan) {
  const CsvTable table(TextOf(plan, "landing_pattern0/data.csv"), "landing_pattern0");
  std::map<std::int64_t, Eigen::Vector3d> places;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    places[table.Integer(row, 0)] = {table.Number(row, 1), table.Number(row, 2),
                                     table.Number(row, 3)};
  }
  return places;
}

double Quantile(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  return values.at(static_cast<std::size_t>(part * static_cast<double>(values.size() - 1)));
}

double Median(const std::vector<double>& values) { return Quantile(values, 0.5); }

// Flies over a standing pattern, down from 12 m above it at 1.2 m/s, ten images a second.
std::vector<Seen> Fly(int frames, Settings settings) {
  settings.insert(
      settings.begin(),
      {fmt::format("frames={}", frames), "rate_hz=10", "shutter.rays_per_pixel=2",
       "ground.map_px=512", "navigation.mount_error_deg=0", "flight.start_altitude_m=12",
       fmt::format("flight.end_altitude_m={}", 12 - 0.12 * frames), "flight.offset_m=0.5"});
  const RecordingPlan plan = PlanLandingScenario("calm", settings, PaperCalibration(), 5);
  const TestFolder folder;
  bool has_zoom = false;
  for (const RecordingFile& file : plan.files) {
    folder.Write(file.name, file.text);
    has_zoom = has_zoom || file.name == "zoom0/data.csv";
  }
  CameraCalibration camera = ReadCalibration(folder / "cam0/sensor.yaml");
  EXPECT_EQ(camera.zoom.has_value(), has_zoom);
  camera.clock_offset =
      DurationFromSeconds(LoadYaml(plan.scene, "scene")["time_offset_s"].as<double>());
  LandingPipeline pipeline(camera, {});
  for (const PoseSample& pose : ParsePoseRows(TextOf(plan, "nav0/data.csv"), "nav0")) {
    pipeline.AddPose(pose);
  }
  std::vector<ZoomSample> reports;
  if (has_zoom) reports = ParseZoomRows(TextOf(plan, "zoom0/data.csv"), "zoom0");
  const std::map<std::int64_t, Eigen::Vector3d> truth = TruePlaces(plan);
  std::vector<Seen> all;
  auto report = reports.begin();
  for (std::size_t i = 0; i < plan.times.size(); ++i) {
    // As in flight: only reports from before the image are there.
    for (; report != reports.end() && report->time <= plan.times[i] + *camera.clock_offset;
         ++report) {
      pipeline.AddZoom(*report);
    }
    const LandingObservation seen = pipeline.Process(plan.render(i), plan.times[i]);
    const auto place = truth.find(ToNanoseconds(plan.times[i]));
    const bool is_placed = seen.center_in_world && place != truth.end();
    all.push_back({ToSeconds(plan.times[i] - kStartTime), seen.is_zooming,
                   is_placed ? (*seen.center_in_world - place->second).norm() : std::nan("")});
  }
  return all;
}

std::vector<double> ErrorsFrom(const std::vector<Seen>& all, double from_s) {
  std::vector<double> errors;
  for (const Seen& seen : all) {
    if (seen.time_s >= from_s && !std::isnan(seen.error_m)) errors.push_back(seen.error_m);
  }
  return errors;
}

TEST(ZoomedFlightTest, PlacesAreThoseOfFixedLens) {
  const std::vector<Seen> fixed = Fly(50, {});
  const std::vector<Seen> zoomed =
      Fly(50, {"zoom.rate_hz=10", "zoom.factor=1.6", "zoom.at_s=1.5", "zoom.takes_s=1"});
  for (const double from_s : {0.0, 3.0}) {
    const std::vector<double> of_fixed = ErrorsFrom(fixed, from_s);
    const std::vector<double> of_zoomed = ErrorsFrom(zoomed, from_s);
    ASSERT_GE(of_fixed.size(), 15u);
    EXPECT_GE(of_zoomed.size() + 15, of_fixed.size());  // while it zooms nothing is found
    EXPECT_LE(Median(of_zoomed), 1.1 * Median(of_fixed)) << from_s;
    EXPECT_LE(Quantile(of_zoomed, 1), 1.3 * Quantile(of_fixed, 1)) << from_s;
  }
}

TEST(ZoomedFlightTest, FramesBetweenSettingsAreLeftOut) {
  for (const double takes_s : {0.0, 1.0}) {
    const int frames = 25 + static_cast<int>(10 * takes_s);  // half a second at rest at the end
    const std::vector<Seen> zoomed =
        Fly(frames, {"zoom.rate_hz=5", "zoom.factor=1.6", "zoom.at_s=1.55",
                     fmt::format("zoom.takes_s={}", takes_s)});
    int left_out = 0;
    for (const Seen& seen : zoomed) {
      left_out += seen.is_zooming;
      // Two reports after it is at rest the lens is known again.
      const bool is_at_rest = seen.time_s < 1.5 || seen.time_s > 1.55 + takes_s + 0.45;
      EXPECT_FALSE(is_at_rest && seen.time_s > 0.1 && seen.is_zooming) << seen.time_s;
      // A report that is a fifth of a second old is 10 % wrong at most.
      EXPECT_FALSE(seen.error_m >= 1.3) << seen.time_s << ": " << seen.error_m;
    }
    EXPECT_GE(left_out, 3);
    EXPECT_LE(left_out, 7 + 10 * takes_s);
  }
}

TEST(ZoomedFlightTest, NothingIsFoundWithoutReports) {
  const std::vector<Seen> zoomed =
      Fly(25, {"zoom.rate_hz=0.01", "zoom.at_s=1.5", "zoom.takes_s=0"});
  for (const Seen& seen : zoomed) {
    EXPECT_TRUE(seen.is_zooming || seen.time_s <= 1.55) << seen.time_s;
  }
}

}  // namespace
}  // namespace kestrel
