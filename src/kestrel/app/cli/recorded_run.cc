// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/recorded_run.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/progress_bar.h"
#include "kestrel/app/views/hunt_view.h"
#include "kestrel/app/views/landing_view.h"
#include "kestrel/core/base/error.h"
#include "kestrel/flight/ros/ros2_result_connection.h"
#include "kestrel/flight/ros/ros_sink.h"
#include "kestrel/flight/session/observation_sinks.h"
#include "kestrel/flight/session/recorded_session.h"

namespace kestrel {
namespace {

// The times of the detection alone.
class DetectTimes : public ObservationSink {
 public:
  void Take(const Observation& observation) override {
    times_ms_.push_back(1e3 * ToSeconds(DetectTime(observation)));
  }
  void Take(const BrokenFrame& frame) override {
    if (broken_++ == 0) first_fault_ = frame.fault;
  }

  std::size_t count() const { return times_ms_.size(); }
  std::size_t broken() const { return broken_; }

  // A line on the images that cannot be read; empty when there is none.
  std::string Faults() const {
    if (broken_ == 0) return "";
    return fmt::format("{} of {} images left out, for example {}\n", broken_,
                       broken_ + times_ms_.size(), first_fault_);
  }

  // For example ", detect_ms median 0.24, p99 0.51"; empty without a frame.
  std::string InWords() const {
    if (times_ms_.empty()) return "";
    std::vector<double> sorted = times_ms_;
    std::sort(sorted.begin(), sorted.end());
    const auto quantile = [&](double part) {  // by nearest rank
      return sorted[static_cast<std::size_t>(std::ceil(part * sorted.size())) - 1];
    };
    return fmt::format(", detect_ms median {:.2f}, p99 {:.2f}", quantile(0.5), quantile(0.99));
  }

 private:
  std::vector<double> times_ms_;
  std::size_t broken_ = 0;
  std::string first_fault_;
};

void PrintSummary(const DetectTimes& times, const Vision& vision) {
  fmt::print(stderr, "{} frame{}, {}{}\n{}{}", times.count(), times.count() == 1 ? "" : "s",
             vision.Found(), times.InWords(), times.Faults(), vision.Remarks());
}

// Throws Interrupted when Ctrl-C left out a part of the recording.
void RequireWhole(const OpenedSource& opened, std::size_t frames) {
  const auto all = opened.source->frame_count();
  if (!WasInterrupted() || frames == all) return;
  throw Interrupted(
      fmt::format("interrupted after {}{} frames: all that is above and in the files "
                  "is of this part",
                  frames, all ? fmt::format(" of {}", *all) : ""));
}

// Shows the progress and, as soon as there is one, the first warning.
class Progress {
 public:
  Progress(std::optional<std::size_t> frames, const Vision* vision)
      : bar_(frames), vision_(vision) {}

  void Show(std::size_t done) {
    if (done > 0) bar_.Show(done);
    if (was_warned_) return;
    const std::string warning = vision_->Warning();
    was_warned_ = !warning.empty();
    if (was_warned_) bar_.Say(warning);
  }

 private:
  ProgressBar bar_;
  const Vision* vision_;
  bool was_warned_ = false;
};

void Run(const OpenedSource& opened, Vision* vision, ObservationSink* sink,
         const std::function<void(std::size_t done)>& on_frame) {
  Progress progress(opened.source->frame_count(), vision);
  std::size_t frames = 0;
  RunRecording(opened, vision, sink, [&](std::size_t done) {
    frames = done;
    progress.Show(done);
    on_frame(done);
    return !WasInterrupted();
  });
  progress.Show(frames);
}

}  // namespace

void AddDdsSink(const SourceArguments& arguments, const OpenedSource& opened,
                const KestrelOptions& options, bool has_world, const ObjectModel& model,
                ObservationSinks* sinks) {
  if (!arguments.dds.is_given()) return;
  const ResultTopics topics = model.classes.empty() ? ResultTopics(kLandingTopics) : kHuntTopics;
  auto connection = std::make_unique<Ros2ResultConnection>(arguments.dds.OpenNode(options.dds),
                                                           options.dds.node, topics);
  sinks->Add(MakeWaitingRosSink(std::make_unique<RosResults>(
      std::move(connection), options.dds, OwnFrames(options.dds, has_world), opened.calibration,
      options.landing, model)));
}

void AddMcapSink(const SourceArguments& arguments, const OpenedSource& opened,
                 const std::variant<LandingView, HuntView>& view, ObservationSinks* sinks) {
  if (arguments.mcap.empty()) return;
  RequireNoSource(arguments.mcap, arguments.sources);
  sinks->Add(OpenMcapFile(arguments.mcap, arguments.force, opened.calibration.intrinsics, view));
}

void RunToEnd(const OpenedSource& opened, Vision* vision, ObservationSinks* sinks,
              const std::function<void(std::size_t done)>& on_frame) {
  CatchInterrupts();
  const DetectTimes* const times = sinks->Add(std::make_unique<DetectTimes>());
  try {
    Run(opened, vision, sinks, on_frame);
  } catch (const InputError&) {
    if (times->count() > 0) PrintSummary(*times, *vision);
    throw;
  }
  sinks->Finish();
  PrintSummary(*times, *vision);
  RequireWhole(opened, times->count() + times->broken());
}

}  // namespace kestrel
