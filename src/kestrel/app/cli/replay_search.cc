// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/replay_search.h"

#include <filesystem>
#include <utility>
#include <variant>

#include "kestrel/io/recording/euroc_recording.h"
#include "kestrel/io/recording/event_source.h"

namespace kestrel {

Duration ReplayRun::Process(const Frame& frame) {
  constexpr std::size_t kFramesPerReport = 20;
  const Duration detect_time = Add(frame, &result_);
  if (tell_ && done() % kFramesPerReport == 0) tell_(done());
  return detect_time;
}

ReplayResult ReplayRun::TakeResult() {
  Complete(&result_);
  return std::move(result_);
}

std::optional<ReplayResult> DetectAgain(const SourceArguments& source, PixelFormat format,
                                        const ReplaySearch::StartRun& start,
                                        const SecondRun::GoOn& go_on) {
  const OpenedSource opened = source.Open(format);
  const std::unique_ptr<ReplayRun> run = start(opened);
  const Duration lead =
      opened.calibration.clock_offset.value_or(Duration::zero()) + run->after_frame();
  RecordingEvents events(opened.source.get(), opened.source->poses(), lead);
  while (go_on(run->done())) {
    const Event event = events.Next();
    if (std::holds_alternative<EndOfStream>(event)) return run->TakeResult();
    if (const auto* pose = std::get_if<PoseSample>(&event)) run->AddPose(*pose);
    if (const auto* frame = std::get_if<Frame>(&event)) run->Process(*frame);
  }
  return std::nullopt;
}

std::optional<std::string> FindTruth(const std::vector<std::string>& sources,
                                     const std::string& table_name) {
  if (sources.size() != 1) return std::nullopt;
  const auto found = FindEurocRoot(sources.front());
  if (!found) return std::nullopt;
  const std::filesystem::path root(*found);
  const bool is_known = std::filesystem::exists(root / table_name) &&
                        std::filesystem::exists(root / "state_groundtruth_estimate0" / "data.csv");
  return is_known ? std::optional(sources.front()) : std::nullopt;
}

}  // namespace kestrel
