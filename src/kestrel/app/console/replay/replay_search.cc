// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/replay_search.h"

#include <filesystem>

#include "kestrel/app/console/replay/frame_winder.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"

namespace kestrel {
namespace {

// Runs over the recording once more. Returns nothing when it was stopped.
std::optional<ReplayResult> DetectAgain(const RecordingChoice& choice,
                                        const ReplaySearch::StartRun& start,
                                        const SecondRun::GoOn& go_on) {
  const OpenedSource opened = OpenRecording(choice);
  const ReplayRun run = start(opened);
  const FlightEnd end = run.session->Run([&] { return !go_on(run.frames->done()); });
  if (end.outcome == FlightOutcome::kStopped) return std::nullopt;
  return run.frames->TakeResult();
}

}  // namespace

ReplayConsole::Recording RecordingOf(const RecordingChoice& choice, const ReplaySearch& search) {
  RecordingChoice quiet = choice;  // the run over the recording has told what is left out
  quiet.bag.notify = {};
  const auto open = [quiet]() -> ReplayConsole::ReadFrame {
    const auto winder = std::make_shared<FrameWinder>([quiet] { return OpenFrames(quiet); });
    return [winder](std::size_t index) { return winder->Read(index); };
  };
  const auto detect = [choice, &search](const std::vector<std::string>& settings) {
    return [choice, start = search.Detect(settings)](const SecondRun::GoOn& go_on) {
      return DetectAgain(choice, start, go_on);
    };
  };
  return {open, detect};
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
