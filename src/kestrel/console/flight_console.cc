// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/console/flight_console.h"

#include <limits>
#include <utility>

#include "kestrel/base/error.h"
#include "kestrel/onboard/thread_setup.h"

namespace kestrel {
namespace {

// Frames that wait to be shown: more are too old for a live picture.
constexpr std::size_t kSeenFrames = 2;
constexpr Duration kPatience = std::chrono::milliseconds(200);
// Times of frames that wait for the checks: some seconds.
constexpr std::size_t kArrivals = 256;
constexpr Duration kCheckInterval = std::chrono::seconds(2);
constexpr Duration kObeyInterval = std::chrono::milliseconds(50);

ConsoleFeed::Description DescriptionOf(const std::string& title, const FlightView& view,
                                       bool has_colors) {
  const bool is_hunt = std::holds_alternative<HuntView>(view);
  ConsoleFeed::Description description{
      .title = title,
      .is_live = true,
      .series = is_hunt ? HuntSeries() : LandingSeries(),
      .layers = is_hunt ? HuntLayers() : LandingLayers(),
      .views = is_hunt ? HuntImageViews(std::get<HuntView>(view)) : LandingImageViews(),
      .offers = {ConsoleCommandKind::kRecord, ConsoleCommandKind::kSnapshot},
      .has_colors = has_colors};
  description.series.push_back({"latency", "ms", "Capture to result"});
  description.series.push_back({"link", "1/s", "Packets"});
  return description;
}

}  // namespace

FlightConsole::FlightConsole(const ConsoleOptions& options, const std::string& title,
                             FlightView view, FlightExamination examination, ChannelFeed* channels,
                             std::optional<FlightColors> colors)
    : view_(std::move(view)),
      feed_(DescriptionOf(title, view_, colors.has_value())),
      seen_(kSeenFrames),
      arrivals_(kArrivals),
      examination_(std::move(examination)),
      link_rate_hz_(std::numeric_limits<double>::quiet_NaN()),
      server_(options, &feed_, WebAssets(), channels) {
  if (colors) TeachColors(*colors);
  thread_ = std::thread([this] { Show(); });
}

// They begin with the model that the flight uses.
void FlightConsole::TeachColors(const FlightColors& colors) {
  kept_.emplace(colors.frames);
  const auto keep = [this] {
    const Image newest = Newest();
    return kept_->Keep(newest.image, newest.captured);
  };
  colors_.emplace(
      ColorSource{.recording = std::filesystem::absolute(colors.frames).lexically_normal().string(),
                  .frame_count = 0,
                  .read = [this](std::size_t frame) { return kept_->Read(frame); },
                  .model = std::get<HuntView>(view_).model,
                  .folder = colors.folder,
                  .keep = keep,
                  .warn = colors.warn},
      &feed_);
}

FlightConsole::~FlightConsole() {
  is_over_ = true;
  seen_.Close();
  thread_.join();
  if (obeying_thread_.joinable()) obeying_thread_.join();
}

void FlightConsole::See(const Frame& frame, const LandingObservation& observation) {
  if (!feed_.IsWatched()) return;
  See({frame.image, frame.time, Now() - frame.time, observation}, observation.detect_time);
}

void FlightConsole::See(const Frame& frame, const HuntObservation& observation) {
  if (!feed_.IsWatched()) return;
  See({frame.image, frame.time, Now() - frame.time, observation}, observation.detect_time);
}

void FlightConsole::See(SeenFrame seen, Duration detect_time) {
  arrivals_.Push({seen.captured, seen.captured + seen.latency - detect_time});
  seen_.Push(std::move(seen));
}

void FlightConsole::See(const FlightReport& report) {
  if (const auto health = health_.Update(report, Now())) feed_.Add(*health);
  if (const auto rate_hz = health_.link_rate_hz()) link_rate_hz_ = *rate_hz;
  const std::lock_guard lock(mutex_);
  report_ = report;
  const ConsoleStatus status = FlightStatus(report, vision_);
  if (status == told_) return;
  told_ = status;
  feed_.Add(status);
}

void FlightConsole::SeeTeam(const TeamReport& report) {
  if (const auto* const view = std::get_if<HuntView>(&view_)) feed_.Add(HuntTeam(*view, report));
}

void FlightConsole::Show() {
  SetUpThisThread("console frames", {});
  while (!is_over_) {
    if (auto seen = seen_.Pop(kPatience)) Show(*std::move(seen));
    while (const auto frame = arrivals_.TryPop()) examination_.AddFrame(*frame);
    ShowChecks();
  }
}

void FlightConsole::Show(SeenFrame seen) {
  frame_.captured = seen.captured;
  frame_.image = std::move(seen.image);
  std::visit([&](const auto& observation) { Show(observation, seen.latency); }, seen.observation);
  examination_.Look(frame_.image, Now());
  {
    const std::lock_guard lock(mutex_);
    shown_ = {frame_.image, frame_.captured};
  }
  feed_.SetFrame(&frame_);
}

void FlightConsole::ShowChecks() {
  const Time now = Now();
  if (!feed_.IsWatched() || now - examined_ < kCheckInterval) return;
  examined_ = now;
  FlightReport report;
  {
    const std::lock_guard lock(mutex_);
    report = report_;
  }
  ConsoleDoctor doctor;
  for (const Finding& finding : examination_.Check(report)) {
    doctor.checks.push_back(
        {finding.check, ToString(finding.verdict), finding.measured, finding.advice});
  }
  feed_.Add(std::move(doctor));
}

void FlightConsole::Show(const LandingObservation& observation, Duration latency) {
  const LandingView& view = std::get<LandingView>(view_);
  examination_.Look(observation);
  frame_.shapes = LandingShapes(view, observation);
  AddSample(LandingSample(observation), latency);
  feed_.Add(LandingMap(view, observation));
  SetVision(LandingStatus(observation));
}

void FlightConsole::Show(const HuntObservation& observation, Duration latency) {
  const HuntView& view = std::get<HuntView>(view_);
  frame_.shapes = HuntShapes(view, observation);
  AddSample(HuntSample(observation), latency);
  feed_.Add(HuntMap(view, observation));
  SetVision(HuntStatus(observation));
}

void FlightConsole::AddSample(ConsoleSample sample, Duration latency) {
  sample.values.push_back(1e3 * ToSeconds(latency));
  sample.values.push_back(link_rate_hz_);
  feed_.Add(std::move(sample));
}

void FlightConsole::Obey(FlightRequests requests) {
  obeying_thread_ = std::thread([this, requests = std::move(requests)] {
    SetUpThisThread("console asks", {});
    while (!is_over_) {
      while (const auto command = feed_.TakeCommand()) Obey(requests, *command);
      std::this_thread::sleep_for(kObeyInterval);
    }
  });
}

void FlightConsole::Obey(const FlightRequests& requests, const ConsoleCommand& command) {
  try {
    if (command.kind == ConsoleCommandKind::kRecord) {
      Say(EventLevel::kInfo, requests.record(command.value != 0));
    } else if (command.kind == ConsoleCommandKind::kSnapshot) {
      KeepSnapshot(requests);
    }
  } catch (const InputError& error) {
    Say(EventLevel::kError, error.what());
  }
}

void FlightConsole::KeepSnapshot(const FlightRequests& requests) {
  const Image newest = Newest();
  if (newest.image.empty()) {
    return Say(EventLevel::kWarning, "no snapshot: there is no image yet");
  }
  Say(EventLevel::kInfo, requests.keep_snapshot(newest.image, newest.captured));
}

FlightConsole::Image FlightConsole::Newest() {
  const std::lock_guard lock(mutex_);
  return shown_;
}

void FlightConsole::SetVision(const ConsoleStatus& status) {
  const std::lock_guard lock(mutex_);
  vision_ = status;
}

}  // namespace kestrel
