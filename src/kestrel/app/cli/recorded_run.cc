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
#include "kestrel/flight/ros/ros2_result_connection.h"
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

// Shows the progress and, as soon as there is one, the first warning.
class Progress {
 public:
  Progress(std::optional<std::size_t> frames, const Vision& vision)
      : bar_(frames), vision_(vision) {}

  void Show(std::size_t done) {
    if (done > 0) bar_.Show(done);
    if (was_warned_) return;
    const std::string warning = vision_.Warning();
    was_warned_ = !warning.empty();
    if (was_warned_) bar_.Report(warning);
  }

 private:
  ProgressBar bar_;
  const Vision& vision_;
  bool was_warned_ = false;
};

void Run(const OpenedSource& opened, RecordedSession* session,
         const std::function<void(std::size_t done)>& on_frame) {
  Progress progress(opened.source->frame_count(), session->vision());
  session->Run([&](std::size_t done) {
    progress.Show(done);
    on_frame(done);
    return !WasInterrupted();
  });
  progress.Show(session->frames() - session->broken());
}

}  // namespace

void AddDdsSink(const SourceArguments& arguments, const OpenedSource& opened,
                const KestrelOptions& options, const Task& task, bool has_world,
                const ObjectModel& model, ObservationSinks* sinks) {
  if (!arguments.dds.is_given()) return;
  auto connection = std::make_unique<Ros2ResultConnection>(arguments.dds.OpenNode(options.dds),
                                                           options.dds.node, task.topics());
  sinks->Add(MakeWaitingRosSink(std::make_unique<RosResults>(
      std::move(connection), options.dds, OwnFrames(options.dds, has_world), opened.calibration,
      options.landing, model)));
}

void AddMcapSink(const SourceArguments& arguments, const OpenedSource& opened, const Task& task,
                 ObservationSinks* sinks) {
  if (arguments.mcap.empty()) return;
  RequireNoSource(arguments.mcap, arguments.sources);
  sinks->Add(
      OpenMcapFile(arguments.mcap, arguments.force, task, opened.calibration, opened.further));
}

void RunToEnd(const OpenedSource& opened, RecordedSession* session,
              const std::function<void(std::size_t done)>& on_frame) {
  CatchInterrupts();
  try {
    Run(opened, session, on_frame);
  } catch (const InputError&) {
    if (session->frames() > session->broken()) fmt::print(stderr, "{}", session->Summary());
    throw;
  }
  fmt::print(stderr, "{}", session->Summary());
  RequireWhole(opened, session->frames());
}

}  // namespace kestrel
