// SPDX-License-Identifier: BSD-3-Clause
// Prints whether the map says that yellow discs move, and how fast, by the number of sightings: 20
// simulated hunts over discs that stand or drive straight on, with a right clock offset and one
// that is wrong by 20 ms. Usage: mover_accuracy [--hunts N] [--first-seed N]
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "for_each_index.h"
#include "kestrel/app/evaluation/object_truth.h"
#include "kestrel/app/evaluation/report_table.h"
#include "kestrel/app/evaluation/statistics.h"
#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"
#include "kestrel/simulation/recordings/hunt_simulation.h"
#include "kestrel/simulation/recordings/scenarios.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr std::array kSpeeds_mps = {0.0, 0.3, 0.6, 1.4, 2.0};
constexpr std::array kClockErrors_ms = {0, 20};
constexpr double kReadout_s = 0.025;

// The map's reports of one disc after each of its sightings, in order.
struct DiscReport {
  std::vector<bool> moves;
  std::vector<double> velocity_errors_mps;
};
// Reports by error of the clock (ms) and speed (m/s).
using Reports = std::map<std::pair<int, double>, std::vector<DiscReport>>;

// A flight to and fro over an area of 16 m x 10 m at a height of 6 m, like that of `kestrel
// simulate hunt`; all discs are yellow.
HuntSimulationOptions HuntOptions(double speed_mps) {
  return ReadHuntSimulation(
      "sweep", "",
      {"frames=50", "shutter.rays_per_pixel=2", "flight.length_m=16", "flight.width_m=10",
       "objects.red=0", "objects.green=0", "objects.blue=0", "objects.orange=0",
       "objects.orange_bars=0", "objects.distractors=0", "banners=0", "vehicles=0",
       "navigation.mount_error_deg=0", "navigation.clock_offset_min_s=0",
       "navigation.clock_offset_max_s=0", "objects.yellow=14", "objects.yellow_path=straight",
       fmt::format("objects.yellow_speed_mps={}", speed_mps)});
}

const std::string& FileOf(const RecordingPlan& plan, const std::string& name) {
  for (const RecordingFile& file : plan.files) {
    if (file.name == name) return file.text;
  }
  throw InputError("the simulated hunt has no " + name);
}

// The pipeline of a hunt with all poses, and a clock offset that is wrong by 'clock_error_ms'.
HuntPipeline MakePipeline(const RecordingPlan& plan, int clock_error_ms) {
  CameraCalibration calibration = HuntCalibration();
  calibration.clock_offset = std::chrono::milliseconds(clock_error_ms);
  HuntPipelineOptions options;
  options.readout_s = kReadout_s;
  HuntPipeline pipeline(calibration, DefaultObjectModel(), options);
  for (const PoseSample& pose : ParsePoseRows(FileOf(plan, "nav0/data.csv"), "nav0/data.csv")) {
    pipeline.AddPose(pose);
  }
  return pipeline;
}

// The disc nearest to an entry of the map that was seen at this time; null when none is near.
const TrueSighting* DiscOf(const MappedObject& object, const std::vector<TrueSighting>& sightings) {
  constexpr double kReach_m = 0.7;
  const TrueSighting* nearest = nullptr;
  double least_m = kReach_m;
  for (const TrueSighting& sighting : sightings) {
    const double distance_m = (sighting.position_in_world - object.position()).norm();
    if (sighting.time != object.last_seen || distance_m >= least_m) continue;
    least_m = distance_m;
    nearest = &sighting;
  }
  return nearest;
}

void Judge(const HuntPipeline& pipeline, Time time, const std::vector<TrueSighting>& sightings,
           std::map<std::int64_t, DiscReport>* reports) {
  for (const MappedObject& object : pipeline.map().objects()) {
    if (object.last_seen != time) continue;
    const TrueSighting* const truth = DiscOf(object, sightings);
    if (truth == nullptr) continue;
    DiscReport& report = (*reports)[object.id];
    report.moves.push_back(object.moves);
    report.velocity_errors_mps.push_back((object.velocity() - truth->velocity_in_world).norm());
  }
}

Reports Hunt(double speed_mps, std::uint64_t seed) {
  const RecordingPlan plan = PlanHunt(HuntOptions(speed_mps), HuntCalibration(), seed);
  const TrueObjects objects = ParseTrueObjects(FileOf(plan, "objects0/objects.csv"), "objects.csv");
  const auto sightings = ParseTrueSightings(FileOf(plan, "objects0/data.csv"), "data.csv", objects);
  std::vector<HuntPipeline> pipelines;
  for (const int error_ms : kClockErrors_ms) pipelines.push_back(MakePipeline(plan, error_ms));
  std::array<std::map<std::int64_t, DiscReport>, kClockErrors_ms.size()> by_id;
  for (std::size_t i = 0; i < plan.times.size(); ++i) {
    const cv::Mat image = plan.render(i);
    for (std::size_t k = 0; k < pipelines.size(); ++k) {
      pipelines[k].Process(image, plan.times[i]);
      Judge(pipelines[k], plan.times[i], sightings, &by_id[k]);
    }
  }
  Reports reports;
  for (std::size_t k = 0; k < pipelines.size(); ++k) {
    for (auto& [id, report] : by_id[k]) {
      reports[{kClockErrors_ms[k], speed_mps}].push_back(std::move(report));
    }
  }
  return reports;
}

ReportTable SightingsTable(const Reports& reports) {
  ReportTable table{"sightings",
                    "After so many sightings",
                    "",
                    {"clock off by, ms", "speed, m/s", "sightings", "moving right",
                     "velocity error median, m/s", "95 %", "worst"},
                    {}};
  for (const auto& [key, discs] : reports) {
    for (const std::size_t sightings : {3, 5, 7, 10, 15}) {
      int right = 0;
      std::vector<double> errors_mps;
      for (const DiscReport& disc : discs) {
        if (disc.moves.size() < sightings) continue;
        right += disc.moves[sightings - 1] == (key.second > 0);
        errors_mps.push_back(disc.velocity_errors_mps[sightings - 1]);
      }
      table.rows.push_back(
          {std::to_string(key.first), FormatFixed(key.second, 1), std::to_string(sightings),
           fmt::format("{} of {}", right, errors_mps.size()), FormatFixed(Median(errors_mps), 3),
           FormatFixed(Quantile(errors_mps, 0.95), 3), FormatFixed(Quantile(errors_mps, 1), 3)});
    }
  }
  return table;
}

// For the discs that were seen at least three times.
ReportTable ReportsTable(const Reports& reports) {
  constexpr std::size_t kConfirmed = 3;
  ReportTable table{"said",
                    "When it is said",
                    "",
                    {"clock off by, ms", "speed, m/s", "discs", "said to move",
                     "sightings until then, median", "most"},
                    {}};
  for (const auto& [key, discs] : reports) {
    int count = 0;
    std::vector<double> until;
    for (const DiscReport& disc : discs) {
      if (disc.moves.size() < kConfirmed) continue;
      ++count;
      const auto reported = std::find(disc.moves.begin(), disc.moves.end(), true);
      if (reported != disc.moves.end()) until.push_back(1.0 + (reported - disc.moves.begin()));
    }
    table.rows.push_back({std::to_string(key.first), FormatFixed(key.second, 1),
                          std::to_string(count), std::to_string(until.size()),
                          FormatFixed(Median(until), 0), FormatFixed(Quantile(until, 1), 0)});
  }
  return table;
}

void Run(int hunts, std::uint64_t first_seed) {
  Reports reports;
  std::mutex mutex;
  ForEachIndex(hunts, [&](std::size_t i) {
    const Reports more = Hunt(kSpeeds_mps[i % kSpeeds_mps.size()], first_seed + i);
    const std::lock_guard lock(mutex);
    for (const auto& [key, discs] : more) {
      auto& all = reports[key];
      all.insert(all.end(), discs.begin(), discs.end());
    }
  });
  fmt::print("{}\n{}", ToMarkdown(SightingsTable(reports)), ToMarkdown(ReportsTable(reports)));
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("Whether the map says what moves, and how fast");
  int hunts = 20;
  std::uint64_t first_seed = 1;
  app.add_option("--hunts", hunts, "Simulated hunts")->check(CLI::PositiveNumber);
  app.add_option("--first-seed", first_seed, "Seed of the first");
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] {
    kestrel::Run(hunts, first_seed);
    return 0;
  });
}
