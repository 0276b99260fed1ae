// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/pipeline_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/frame_loop.h"
#include "kestrel/core/base/error.h"
#include "kestrel/flight/ros/ros2_result_connection.h"
#include "kestrel/io/recording/event_source.h"

namespace kestrel {
namespace {

// For example ", detect_ms median 0.24, p99 0.51"; empty without a frame.
std::string InWords(std::vector<double> detect_ms) {
  if (detect_ms.empty()) return "";
  std::sort(detect_ms.begin(), detect_ms.end());
  const auto quantile = [&](double part) {  // by nearest rank
    return detect_ms[static_cast<std::size_t>(std::ceil(part * detect_ms.size())) - 1];
  };
  return fmt::format(", detect_ms median {:.2f}, p99 {:.2f}", quantile(0.5), quantile(0.99));
}

void PrintSummary(const std::vector<double>& detect_ms, const PipelineRun& run) {
  fmt::print(stderr, "{} frames, {}{}\n{}", detect_ms.size(), run.Found(), InWords(detect_ms),
             run.Remarks());
}

}  // namespace

std::unique_ptr<RosResults> OpenRosResults(const SourceArguments& arguments,
                                           const OpenedSource& opened,
                                           const KestrelOptions& options, bool is_still,
                                           const ObjectModel& model) {
  if (!arguments.dds.is_given()) return nullptr;
  auto results = std::make_unique<RosResults>(
      std::make_unique<Ros2ResultConnection>(
          arguments.dds.OpenNode(options.dds), options.dds.node,
          model.classes.empty() ? ResultTopics(kLandingTopics) : kHuntTopics),
      WireFormat::kCdr, options.dds, OwnFrames(options.dds, opened.has_world() && !is_still),
      opened.calibration, options.landing, model);
  results->WaitForSubscribers(std::chrono::seconds(1));
  return results;
}

void RunPipeline(const OpenedSource& opened, PipelineRun* run) {
  const Duration lead =
      opened.calibration.clock_offset.value_or(Duration::zero()) + run->after_frame();
  RecordingEvents events(opened.source.get(), opened.source->poses(), lead);
  std::vector<double> detect_ms;
  bool was_warned = false;
  try {
    const auto process = [&](const Frame& frame, const ProgressBar& progress) {
      detect_ms.push_back(1e3 * ToSeconds(run->Process(frame)));
      if (was_warned) return;
      const std::string warning = run->Warning();
      was_warned = !warning.empty();
      if (was_warned) progress.Say(warning);
    };
    ForEachEvent(
        &events, opened.source->frame_count(), opened.calibration.intrinsics,
        [run](const PoseSample& pose) { run->AddPose(pose); }, process);
  } catch (const InputError&) {
    if (!detect_ms.empty()) PrintSummary(detect_ms, *run);
    throw;
  }
  run->Finish();
  PrintSummary(detect_ms, *run);
}

}  // namespace kestrel
