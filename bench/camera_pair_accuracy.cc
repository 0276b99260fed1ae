// SPDX-License-Identifier: BSD-3-Clause
// Prints what a second camera brings: flights with a wide camera alone, with a narrow one beside it
// over a standing pattern, and with one that looks ahead over a pick-up at 15 km/h; and what
// happens when the second camera fails there. Usage: camera_pair_accuracy [--flights N]
// [--first-seed N] [--table faults|contact]
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "for_each_index.h"
#include "kestrel/app/evaluation/landing_truth.h"
#include "kestrel/app/evaluation/report_table.h"
#include "kestrel/app/evaluation/statistics.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/load_yaml.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"
#include "kestrel/simulation/recordings/recording_plan.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"
#include "report_main.h"

namespace kestrel {
namespace {

using Settings = std::vector<std::string>;

constexpr double kFaultAt_s = 2.5;
constexpr Duration kPosesAhead = std::chrono::milliseconds(100);
constexpr std::array kFaults = {"none", "dead", "frozen", "late", "mount"};
constexpr std::array kExpected = {CameraHealth::kGood, CameraHealth::kSilent, CameraHealth::kFrozen,
                                  CameraHealth::kContradicts, CameraHealth::kContradicts};

const std::string& FileOf(const RecordingPlan& plan, const std::string& name) {
  for (const RecordingFile& file : plan.files) {
    if (file.name == name) return file.text;
  }
  throw InputError("the simulated flight has no " + name);
}

// A flight, with the images that were rendered once.
class Flight {
 public:
  Flight(const std::string& scenario, Settings settings, std::uint64_t seed) {
    settings.insert(settings.begin(),
                    {"rate_hz=10", "second.rate_hz=10", "shutter.rays_per_pixel=2",
                     "navigation.mount_error_deg=0.2"});
    plan_ = PlanLandingScenario(scenario, settings, PaperCalibration(), seed);
    const YAML::Node scene = LoadYaml(plan_.scene, "scene.yaml");
    for (const char* name : {"cam0/sensor.yaml", "cam1/sensor.yaml"}) {
      cameras_.push_back(ParseCalibration(FileOf(plan_, name), name));
    }
    cameras_[0].clock_offset = DurationFromSeconds(scene["time_offset_s"].as<double>());
    cameras_[1].clock_offset = DurationFromSeconds(scene["cam1"]["time_offset_s"].as<double>());
    poses_ = ParsePoseRows(FileOf(plan_, "nav0/data.csv"), "nav0/data.csv");
    truth_ = ParseTruePatterns(FileOf(plan_, "landing_pattern0/data.csv"), "landing_pattern0");
  }

  const RecordingPlan& plan() const { return plan_; }
  const std::vector<CameraCalibration>& cameras() const { return cameras_; }
  const std::vector<PoseSample>& poses() const { return poses_; }
  const std::vector<TruePattern>& truth() const { return truth_; }

  const cv::Mat& Image(std::size_t camera, std::size_t index) const {
    cv::Mat& image = images_[{camera, index}];
    if (image.empty()) image = camera == 0 ? plan_.render(index) : plan_.further[0].render(index);
    return image;
  }

 private:
  RecordingPlan plan_;
  std::vector<CameraCalibration> cameras_;
  std::vector<PoseSample> poses_;
  std::vector<TruePattern> truth_;
  mutable std::map<std::pair<std::size_t, std::size_t>, cv::Mat> images_;
};

struct Result {
  std::optional<double> first_contact_m;  // height of the first sighting that the track took
  std::vector<double> errors_m;           // of the track, in the last two seconds
  double largest_jump = 0;                // of the track where the camera changes, in sigmas
  TrackState end = TrackState::kSearching;
  CameraState first, second;
  int seen_after_fault = 0;  // images of the second camera in which it saw the pad
};

// Runs the pipeline over the flight. 'second': times and images of the second camera; null: the
// first camera alone.
Result RunFlight(const Flight& flight, const RecordingPlan::Camera* second) {
  const std::size_t count = second == nullptr ? 1 : 2;
  LandingPipeline pipeline(std::span(flight.cameras()).first(count), {});
  std::multimap<Time, std::pair<std::size_t, std::size_t>> images;  // by time of the first clock
  for (std::size_t i = 0; i < flight.plan().times.size(); ++i) {
    images.insert({flight.plan().times[i], {0, i}});
  }
  const Duration ahead = *flight.cameras()[1].clock_offset - *flight.cameras()[0].clock_offset;
  for (std::size_t i = 0; second != nullptr && i < second->times.size(); ++i) {
    images.insert({second->times[i] + ahead, {1, i}});
  }
  Result result;
  std::optional<std::size_t> last;
  auto pose = flight.poses().begin();
  for (const auto& [time, image] : images) {
    const auto [camera, index] = image;
    // As they come in a flight: the pipeline keeps the latest ten seconds.
    const Time needed = time + *flight.cameras()[0].clock_offset + kPosesAhead;
    for (; pose != flight.poses().end() && pose->time < needed; ++pose) pipeline.AddPose(*pose);
    const auto before = pipeline.tracker().Predict(time);
    const LandingObservation seen =
        camera == 0 ? pipeline.Process(flight.Image(0, index), time, 0)
                    : pipeline.Process(second->render(index), second->times[index], 1);
    const auto truth = TrueMotionAt(flight.truth(), time);
    const bool is_after = ToSeconds(time - flight.plan().times.front()) > kFaultAt_s;
    result.seen_after_fault += camera == 1 && is_after && seen.report.detection;
    result.end = seen.track_state;
    if (truth && seen.target && flight.truth().back().time - time < std::chrono::seconds(2)) {
      result.errors_m.push_back((seen.target->motion.position() - truth->position_in_world).norm());
    }
    if (seen.fate != MeasurementFate::kAccepted) continue;
    if (!result.first_contact_m && truth) {
      result.first_contact_m =
          seen.world_from_camera->translation.z() - truth->position_in_world.z();
    }
    if (before && last && *last != camera) {
      const double jump_m = (seen.target->motion.position() - before->motion.position()).norm();
      result.largest_jump = std::max(result.largest_jump, jump_m / before->position_sigma_m());
    }
    last = camera;
  }
  result.first = pipeline.camera_state(0);
  if (count > 1) result.second = pipeline.camera_state(1);
  return result;
}

// The second camera as it is without a fault.
RecordingPlan::Camera Healthy(const Flight& flight) {
  return {flight.plan().further[0].times,
          [&flight](std::size_t index) { return flight.Image(1, index); }};
}

// The second camera with a fault: images before it are those of the healthy camera.
RecordingPlan::Camera Faulty(const Flight& flight, const RecordingPlan::Camera& faulty) {
  const auto first = static_cast<std::size_t>(kFaultAt_s * 10 + 1);
  return {faulty.times, [&flight, &faulty, first](std::size_t index) {
            return index < first ? flight.Image(1, index) : faulty.render(index);
          }};
}

struct Summary {
  std::vector<double> contacts_m, errors_m, jumps;
  std::vector<double> seen_after_fault;
  int flights = 0, tracking = 0, named = 0, first_used = 0;

  void Add(const Result& result, CameraHealth expected) {
    ++flights;
    tracking += result.end == TrackState::kTracking || result.end == TrackState::kPredicting;
    named += result.second.health == expected;
    first_used += result.first.health == CameraHealth::kGood;
    if (result.first_contact_m) contacts_m.push_back(*result.first_contact_m);
    if (!result.errors_m.empty()) errors_m.push_back(RootMeanSquare(result.errors_m));
    jumps.push_back(result.largest_jump);
    seen_after_fault.push_back(result.seen_after_fault);
  }
};

// Calls 'fly' with each seed, on all cores, and 'add' with its results, one after the other.
template <class Fly, class Add>
void FlyAll(int flights, std::uint64_t first_seed, const Fly& fly, const Add& add) {
  std::mutex mutex;
  ForEachIndex(flights, [&](std::size_t i) {
    const auto results = fly(first_seed + i);
    const std::lock_guard lock(mutex);
    add(results);
  });
}

ReportTable ContactTable(int flights, std::uint64_t first_seed) {
  struct Pair {
    std::string name, scenario;
    Settings settings;
  };
  // A UAV that flies after a car leans by more than a narrow lens sees: that one needs a gimbal
  // there.
  const std::vector<Pair> pairs = {
      {"down and 45 degrees ahead",
       "figure8",
       {"second.fov_deg=100", "second.tilt_deg=45", "flight.start_altitude_m=14",
        "flight.end_altitude_m=1", "flight.offset_m=0.6", "frames=50"}},
      {"wide and narrow",
       "calm",
       {"second.fov_deg=30", "flight.start_altitude_m=45", "flight.end_altitude_m=1",
        "flight.offset_m=0.05", "frames=180"}}};
  ReportTable table{"contact",
                    "Beside the first camera alone",
                    "",
                    {"cameras", "flights", "first contact, m, median", "least",
                     "error RMS of the last 2 s, m, median", "largest",
                     "largest jump where the camera changes, sigmas"},
                    {}};
  for (const auto& [name, scenario, settings] : pairs) {
    std::array<Summary, 2> summaries;  // alone, both
    FlyAll(
        flights, first_seed,
        [&](std::uint64_t seed) {
          const Flight flight(scenario, settings, seed);
          const RecordingPlan::Camera second = Healthy(flight);
          return std::array{RunFlight(flight, nullptr), RunFlight(flight, &second)};
        },
        [&](const std::array<Result, 2>& results) {
          for (std::size_t i = 0; i < 2; ++i) summaries[i].Add(results[i], CameraHealth::kGood);
        });
    for (std::size_t i = 0; i < 2; ++i) {
      const Summary& all = summaries[i];
      table.rows.push_back(
          {i == 0 ? name + ": the first alone" : name,
           fmt::format("{} of {}", all.tracking, all.flights),
           FormatFixed(Median(all.contacts_m), 1), FormatFixed(Quantile(all.contacts_m, 0), 1),
           FormatFixed(Median(all.errors_m), 3), FormatFixed(Quantile(all.errors_m, 1), 3),
           i == 0 ? "" : FormatFixed(Quantile(all.jumps, 1), 2)});
    }
  }
  return table;
}

ReportTable FaultTable(int flights, std::uint64_t first_seed) {
  // A UAV that follows a car leans: a narrow camera does not see the pad when its fault begins.
  const Settings settings = {"second.fov_deg=90", "flight.start_altitude_m=12",
                             "flight.end_altitude_m=1.5", "frames=50",
                             fmt::format("second.fault_at_s={}", kFaultAt_s)};
  std::array<Summary, kFaults.size() + 1> summaries;  // the last one: the first camera alone
  FlyAll(
      flights, first_seed,
      [&](std::uint64_t seed) {
        const Flight flight("figure8", settings, seed);
        std::vector<Result> results;
        for (const char* fault : kFaults) {
          Settings with_fault = settings;
          with_fault.push_back(std::string("second.fault=") + fault);
          const Flight faulty("figure8", with_fault, seed);
          const RecordingPlan::Camera second = Faulty(flight, faulty.plan().further[0]);
          results.push_back(RunFlight(flight, &second));
        }
        results.push_back(RunFlight(flight, nullptr));
        return results;
      },
      [&](const std::vector<Result>& results) {
        for (std::size_t i = 0; i < results.size(); ++i) {
          summaries[i].Add(results[i], i < kExpected.size() ? kExpected[i] : CameraHealth::kGood);
        }
      });
  ReportTable table{"faults",
                    "When the second camera fails",
                    "",
                    {"second camera", "flights that go on", "fault named",
                     "images in which it saw the pad after that, median", "least",
                     "first camera used", "error RMS of the last 2 s, m, median", "largest"},
                    {}};
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    const Summary& all = summaries[i];
    const auto of = [&](int count) { return fmt::format("{} of {}", count, all.flights); };
    table.rows.push_back(
        {i < kFaults.size() ? kFaults[i] : "not there", of(all.tracking),
         i < kFaults.size() ? of(all.named) : "", FormatFixed(Median(all.seen_after_fault), 0),
         FormatFixed(Quantile(all.seen_after_fault, 0), 0), of(all.first_used),
         FormatFixed(Median(all.errors_m), 3), FormatFixed(Quantile(all.errors_m, 1), 3)});
  }
  return table;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("What a second camera brings, and what happens when it fails");
  int flights = 20;
  std::uint64_t first_seed = 1;
  app.add_option("--flights", flights, "Simulated flights of each kind")
      ->check(CLI::PositiveNumber);
  app.add_option("--first-seed", first_seed, "Seed of the first");
  std::string table;
  app.add_option("--table", table, "One of the tables only")
      ->check(CLI::IsMember({"faults", "contact"}));
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] {
    if (table != "contact") {
      fmt::print("{}\n", kestrel::ToMarkdown(kestrel::FaultTable(flights, first_seed)));
      std::fflush(stdout);  // the other one takes longer
    }
    if (table == "faults") return 0;
    fmt::print("{}", kestrel::ToMarkdown(kestrel::ContactTable(flights, first_seed)));
    return 0;
  });
}
