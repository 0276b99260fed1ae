// SPDX-License-Identifier: BSD-3-Clause
// Plays a recording through a live session, each frame after the one before is done, and writes the
// tables and what ROS, MCAP and the replay's page get, without times of the wall clock.
//
//   golden_session land|hunt RECORDING FOLDER
#include <atomic>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "kestrel/app/console/messages/console_json.h"
#include "kestrel/app/console/replay/hunt_replay.h"
#include "kestrel/app/console/replay/landing_replay.h"
#include "kestrel/app/console/replay/replay_run.h"
#include "kestrel/app/foxglove/mcap_sink.h"
#include "kestrel/core/base/error.h"
#include "kestrel/flight/onboard/session.h"
#include "kestrel/flight/ros/ros_sink.h"
#include "kestrel/flight/session/observation_sinks.h"
#include "kestrel/flight/session/task.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

// Passes observations on without the times that they took.
class MaskedSinks : public ObservationSink {
 public:
  void Take(const Observation& observation) override {
    Observation masked = observation;
    masked.latency.reset();
    if (auto* const hunt = std::get_if<HuntObservation>(&masked.seen)) {
      hunt->report.segmentation_time = hunt->report.test_time = Duration::zero();
    }
    std::visit([](auto& seen) { seen.detect_time = Duration::zero(); }, masked.seen);
    sinks.Take(masked);
    ++frames;
  }
  void Finish() override { sinks.Finish(); }

  ObservationSinks sinks{SinkErrors::kThrow};
  std::atomic<std::size_t> frames{0};
};

// A recording whose times are not moved to the clock's. A frame comes after its poses, and when the
// sinks have all frames before it.
class SteppedSource : public LiveSource {
 public:
  SteppedSource(const OpenedSource& opened, Duration lead, const MaskedSinks* sinks)
      : events_(opened.source.get(), opened.source->poses(), lead), sinks_(sinks) {}

  std::optional<Event> Next(Duration timeout) override {
    if (sinks_->frames < given_) {
      std::this_thread::sleep_for(std::min<Duration>(timeout, std::chrono::milliseconds(1)));
      return std::nullopt;
    }
    Event event = events_.Next();
    if (std::holds_alternative<Frame>(event)) ++given_;
    return event;
  }
  CaptureCounters counters() const override { return {.captured = given_}; }

 private:
  RecordingEvents events_;
  const MaskedSinks* sinks_;
  std::atomic<std::size_t> given_{0};
};

// Writes the bytes of all messages to a file.
class RosBytes : public ResultConnection {
 public:
  explicit RosBytes(const fs::path& file) : file_(file, std::ios::binary) {}

  bool HasSubscribers(ResultTopic /*topic*/) const override { return true; }
  void Publish(ResultTopic topic, const std::string& bytes) override {
    file_ << InfoOf(topic).name << ' ' << bytes.size() << '\n' << bytes << '\n';
  }

 private:
  std::ofstream file_;
};

// Writes the messages of each frame as the page gets them.
void WritePage(const ReplayResult& result, const fs::path& file) {
  std::ofstream page(file);
  for (const ReplayFrame& frame : result.frames) {
    ConsoleFindings findings;
    findings.runs = {frame.facts};
    page << ToJson(ConsoleUpdate(frame.sample)) << '\n'
         << ToJson(ConsoleUpdate(frame.status)) << '\n'
         << ToJson(ConsoleUpdate(frame.map)) << '\n'
         << ToJson(ConsoleUpdate(findings)) << '\n'
         << FrameJson({.captured = frame.time, .image = {}, .shapes = frame.shapes}, "", {})
         << '\n';
  }
  for (const MapEntry& entry : result.map) page << entry.object.label << '\n';
}

void Play(const std::string& name, const std::string& recording, const fs::path& folder) {
  const ObjectModel model = DefaultObjectModel();
  SessionOptions options{.output = (folder / "tables").string()};
  options.flight.events.pose_wait_s = 1;  // no frame goes without its pose
  const TaskOptions tasks;
  const std::unique_ptr<Task> task = MakeTask(name, tasks);
  const std::unique_ptr<ReplaySearch> search =
      name == "hunt" ? SearchForObjects({recording}, tasks.hunt, model, std::nullopt)
                     : SearchForPattern({recording}, tasks.landing, std::nullopt);
  const RecordingChoice choice{.sources = {recording}, .format = search->format()};
  const OpenedSource opened = OpenRecording(choice);
  fs::create_directories(folder);

  auto masked = std::make_unique<MaskedSinks>();
  MaskedSinks& sinks = *masked;
  sinks.sinks.Add(OpenMcapFile((folder / "session.mcap").string(), /*replace=*/true, *task,
                               opened.calibration));
  sinks.sinks.Add(MakeWaitingRosSink(std::make_unique<RosResults>(
      std::make_shared<RosBytes>(folder / "ros.bin"), DdsOptions(),
      RosFrames{"camera", "map", "base_link"}, opened.calibration, tasks.landing, model)));
  const ReplayRun replay = search->Detect({})(opened);
  sinks.sinks.Add(std::make_unique<GuardedSink>(replay.frames, [](const std::string&) {}));

  const OpenedLiveSource source{
      .source = std::make_unique<SteppedSource>(opened, std::chrono::milliseconds(100), &sinks),
      .calibration = opened.calibration,
      .rate_hz = opened.source->rate_hz(),
      .has_poses = true};
  const auto session = MakeSession(source, *task, options);
  session->sinks().Add(std::move(masked));
  session->Run();
  WritePage(replay.frames->TakeResult(), folder / "page.json");
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  try {
    kestrel::Play(argv[1], argv[2], argv[3]);
  } catch (const kestrel::InputError& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
