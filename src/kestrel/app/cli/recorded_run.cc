// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/recorded_run.h"

#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/progress_bar.h"
#include "kestrel/app/foxglove/mcap_sink.h"
#include "kestrel/core/base/error.h"
#include "kestrel/flight/ros/ros_sink.h"

namespace kestrel {
namespace {

// Throws Interrupted when Ctrl-C left out a part of the recording.
void RequireWhole(const OpenedSource& opened, std::size_t frames) {
  const auto all = opened.source->frame_count();
  if (!WasInterrupted() || frames == all) return;
  throw Interrupted(
      fmt::format("interrupted after {}{} frames: all that is above and in the files "
                  "is of this part",
                  frames, all ? fmt::format(" of {}", *all) : ""));
}

// Shows the progress and the warnings.
class Progress : public ObservationSink {
 public:
  explicit Progress(std::optional<std::size_t> frames) { bar_.emplace(frames); }

  void Take(const Observation& /*observation*/) override { bar_->Show(++seen_); }
  void Take(const BrokenFrame& /*frame*/) override { ++broken_; }
  void Take(const SessionEvent& event) override { bar_->Report(event.text); }
  void Finish() override { bar_.reset(); }

  std::size_t seen() const { return seen_; }
  std::size_t frames() const { return seen_ + broken_; }

 private:
  std::optional<ProgressBar> bar_;
  std::size_t seen_ = 0, broken_ = 0;
};

}  // namespace

void AddDdsSink(const SourceArguments& arguments, const OpenedSource& opened,
                const KestrelOptions& options, const Task& task, bool has_world,
                const ObjectModel& model, ObservationSinks* sinks) {
  if (!arguments.dds.is_given()) return;
  sinks->Add(MakeWaitingRosSink(MakeRos2Results(arguments.dds.OpenNode(options.dds), options,
                                                OwnFrames(options.dds, has_world, opened.further),
                                                task, opened.calibration, opened.further, model)));
}

void AddMcapSink(const SourceArguments& arguments, const OpenedSource& opened, const Task& task,
                 ObservationSinks* sinks) {
  if (arguments.mcap.empty()) return;
  RequireNoSource(arguments.mcap, arguments.sources);
  sinks->Add(
      OpenMcapFile(arguments.mcap, arguments.force, task, opened.calibration, opened.further));
}

void RunToEnd(const OpenedSource& opened, Session* session,
              const std::function<void(std::size_t done)>& on_frame) {
  CatchInterrupts();
  Progress* const progress =
      session->sinks().Add(std::make_unique<Progress>(opened.source->frame_count()));
  try {
    session->Run([&] {
      on_frame(progress->seen());
      return WasInterrupted();
    });
  } catch (const InputError&) {
    progress->Finish();
    if (progress->seen() > 0) fmt::print(stderr, "{}", session->Summary());
    throw;
  }
  fmt::print(stderr, "{}", session->Summary());
  RequireWhole(opened, progress->frames());
}

}  // namespace kestrel
