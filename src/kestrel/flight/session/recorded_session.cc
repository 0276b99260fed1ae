// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/recorded_session.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include <fmt/format.h>

#include "kestrel/io/recording/event_source.h"
#include "kestrel/io/recording/frame_source.h"

namespace kestrel {
namespace {

// For example ", detect_ms median 0.24, p99 0.51"; empty without a frame.
std::string TimesInWords(std::vector<double> ms) {
  if (ms.empty()) return "";
  std::sort(ms.begin(), ms.end());
  const auto quantile = [&](double part) {  // by nearest rank
    return ms[static_cast<std::size_t>(std::ceil(part * ms.size())) - 1];
  };
  return fmt::format(", detect_ms median {:.2f}, p99 {:.2f}", quantile(0.5), quantile(0.99));
}

}  // namespace

RecordedSession::RecordedSession(const OpenedSource& opened, const Task& task,
                                 std::optional<double> altitude_m)
    : RecordedSession(opened, task.MakeVision({.calibration = opened.calibration,
                                               .further = opened.further,
                                               .altitude_m = altitude_m,
                                               .has_world = opened.has_world(),
                                               .is_lens_unknown = opened.is_lens_unknown})) {}

bool RecordedSession::Run(const std::function<bool(std::size_t done)>& go_on) {
  const bool has_ended = RunToEnd(go_on);
  if (has_ended) vision_->Finish();
  sinks_.Finish();
  return has_ended;
}

bool RecordedSession::RunToEnd(const std::function<bool(std::size_t done)>& go_on) {
  opened_.source->set_on_broken([this](const BrokenImage& broken) {
    sinks_.Take(BrokenFrame{broken.name, broken.time, broken.what(), broken.camera});
    if (broken_++ == 0) first_fault_ = broken.what();
  });
  RecordingEvents events(opened_.source.get(), opened_.source->poses(), vision_->pose_lead());
  for (;;) {
    const Event event = events.Next();
    if (std::holds_alternative<EndOfStream>(event)) return true;
    if (const auto* pose = std::get_if<PoseSample>(&event)) vision_->AddPose(*pose);
    if (const auto* report = std::get_if<GimbalSample>(&event)) vision_->AddGimbal(*report);
    const auto* frame = std::get_if<Frame>(&event);
    if (frame == nullptr) continue;
    if (!go_on(times_ms_.size())) return false;
    opened_.RequireSize(*frame);
    const Observation observation = vision_->Process(*frame);
    sinks_.Take(observation);
    times_ms_.push_back(1e3 * ToSeconds(DetectTime(observation)));
  }
}

std::string RecordedSession::Summary() const {
  const std::size_t seen = times_ms_.size();
  std::string summary = fmt::format("{} frame{}, {}{}\n", seen, seen == 1 ? "" : "s",
                                    vision_->Found(), TimesInWords(times_ms_));
  if (broken_ > 0) {
    summary +=
        fmt::format("{} of {} images left out, for example {}\n", broken_, frames(), first_fault_);
  }
  return summary + vision_->Remarks();
}

}  // namespace kestrel
