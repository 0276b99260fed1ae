// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "kestrel/flight/onboard/session.h"
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

std::vector<double> FurtherRates(const OpenedSource& opened) {
  std::vector<double> rates_hz;
  for (std::size_t i = 1; i <= opened.further.size(); ++i) {
    rates_hz.push_back(opened.source->camera_rate_hz(i));
  }
  return rates_hz;
}

class RecordedSession : public Session {
 public:
  RecordedSession(const OpenedSource& opened, std::unique_ptr<Vision> vision,
                  const SessionOptions& options)
      : Session(std::move(vision), SinkErrors::kThrow), opened_(opened), options_(options) {}

  using Session::Run;
  FlightEnd Run(const std::function<bool()>& is_stopped) override {
    OpenTables();
    const bool has_ended = RunToEnd(is_stopped);
    if (has_ended) mutable_vision().Finish();
    // Another sink may wait long for its end, as that of a team does.
    if (tables_) tables_->Finish();
    sinks().Finish();
    return {.outcome = has_ended ? FlightOutcome::kSourceEnded : FlightOutcome::kStopped};
  }

  std::string Summary() const override;

 private:
  // After all other sinks: one that throws has left no folder behind.
  void OpenTables();
  bool RunToEnd(const std::function<bool()>& is_stopped);
  void See(const Frame& frame);

  template <class Result>
  void Give(const Result& result) {
    sinks().Take(result);
    if (tables_) tables_->Take(result);
  }

  const OpenedSource& opened_;
  const SessionOptions options_;
  std::unique_ptr<ObservationSink> tables_;  // null: none are written
  std::vector<double> times_ms_;             // time of the detection, for each frame
  std::size_t broken_ = 0;                   // frames whose image cannot be read
  std::string first_fault_;
  bool was_warned_ = false;
};

void RecordedSession::OpenTables() {
  if (options_.output.empty() && options_.table == nullptr) return;
  tables_ = vision().MakeTables({.folder = options_.output,
                                 .force = options_.replace,
                                 .annotate = options_.annotate,
                                 .rate_hz = opened_.source->rate_hz(),
                                 .further_rates_hz = FurtherRates(opened_),
                                 .only_in_image = opened_.is_lens_unknown,
                                 .stream = options_.table});
}

// Returns whether the end was reached.
bool RecordedSession::RunToEnd(const std::function<bool()>& is_stopped) {
  opened_.source->set_on_broken([this](const BrokenImage& broken) {
    Give(BrokenFrame{broken.name, broken.time, broken.what(), broken.camera});
    if (broken_++ == 0) first_fault_ = broken.what();
  });
  RecordingEvents events(opened_.source.get(), opened_.source->poses(), vision().pose_lead());
  for (;;) {
    const Event event = events.Next();
    if (std::holds_alternative<EndOfStream>(event)) return true;
    if (const auto* pose = std::get_if<PoseSample>(&event)) mutable_vision().AddPose(*pose);
    if (const auto* report = std::get_if<GimbalSample>(&event)) mutable_vision().AddGimbal(*report);
    if (const auto* report = std::get_if<ZoomSample>(&event)) mutable_vision().AddZoom(*report);
    const auto* frame = std::get_if<Frame>(&event);
    if (frame == nullptr) continue;
    if (is_stopped()) return false;
    See(*frame);
  }
}

void RecordedSession::See(const Frame& frame) {
  opened_.RequireSize(frame);
  const Observation observation = mutable_vision().Process(frame);
  Give(observation);
  times_ms_.push_back(1e3 * ToSeconds(DetectTime(observation)));
  if (was_warned_) return;
  const std::string warning = vision().Warning();
  was_warned_ = !warning.empty();
  if (was_warned_) sinks().Take(SessionEvent{frame.time, EventLevel::kWarning, warning});
}

std::string RecordedSession::Summary() const {
  const std::size_t seen = times_ms_.size();
  std::string summary = fmt::format("{} frame{}, {}{}\n", seen, seen == 1 ? "" : "s",
                                    vision().Found(), TimesInWords(times_ms_));
  if (broken_ > 0) {
    summary += fmt::format("{} of {} images left out, for example {}\n", broken_, seen + broken_,
                           first_fault_);
  }
  return summary + vision().Remarks();
}

}  // namespace

std::unique_ptr<Session> MakeSession(const OpenedSource& recording, const Task& task,
                                     const SessionOptions& options) {
  return MakeSession(recording,
                     task.MakeVision({.calibration = recording.calibration,
                                      .further = recording.further,
                                      .altitude_m = options.altitude_m,
                                      .has_world = recording.has_world(),
                                      .is_lens_unknown = recording.is_lens_unknown}),
                     options);
}

std::unique_ptr<Session> MakeSession(const OpenedSource& recording, std::unique_ptr<Vision> vision,
                                     const SessionOptions& options) {
  return std::make_unique<RecordedSession>(recording, std::move(vision), options);
}

}  // namespace kestrel
