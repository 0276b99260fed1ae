// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/console/flight_console.h"

#include <limits>
#include <utility>

#include "kestrel/onboard/thread_setup.h"

namespace kestrel {
namespace {

// Frames that wait to be shown: more are too old for a live picture.
constexpr std::size_t kSeenFrames = 2;
constexpr Duration kPatience = std::chrono::milliseconds(200);

ConsoleFeed::Description DescriptionOf(const std::string& title, const FlightView& view) {
  const bool is_hunt = std::holds_alternative<HuntView>(view);
  ConsoleFeed::Description description{.title = title,
                                       .is_live = true,
                                       .series = is_hunt ? HuntSeries() : LandingSeries(),
                                       .layers = is_hunt ? HuntLayers() : LandingLayers(),
                                       .offers = {}};
  description.series.push_back({"latency", "ms", "Capture to result"});
  description.series.push_back({"link", "1/s", "Packets"});
  return description;
}

}  // namespace

FlightConsole::FlightConsole(const ConsoleOptions& options, const std::string& title,
                             FlightView view)
    : view_(std::move(view)),
      feed_(DescriptionOf(title, view_)),
      seen_(kSeenFrames),
      link_rate_hz_(std::numeric_limits<double>::quiet_NaN()),
      server_(options, &feed_),
      thread_([this] { Show(); }) {}

FlightConsole::~FlightConsole() {
  is_over_ = true;
  seen_.Close();
  thread_.join();
}

void FlightConsole::See(const Frame& frame, const LandingObservation& observation) {
  if (!feed_.IsWatched()) return;
  seen_.Push({frame.image, frame.time, Now() - frame.time, observation});
}

void FlightConsole::See(const Frame& frame, const HuntObservation& observation) {
  if (!feed_.IsWatched()) return;
  seen_.Push({frame.image, frame.time, Now() - frame.time, observation});
}

void FlightConsole::See(const FlightReport& report) {
  if (const auto health = health_.Update(report, Now())) feed_.Add(*health);
  if (const auto rate_hz = health_.link_rate_hz()) link_rate_hz_ = *rate_hz;
  const std::lock_guard lock(mutex_);
  const ConsoleStatus status = FlightStatus(report, vision_);
  if (status == told_) return;
  told_ = status;
  feed_.Add(status);
}

void FlightConsole::Show() {
  SetUpThisThread("console frames", {});
  while (!is_over_) {
    if (auto seen = seen_.Pop(kPatience)) Show(*std::move(seen));
  }
}

void FlightConsole::Show(SeenFrame seen) {
  frame_.captured = seen.captured;
  frame_.image = std::move(seen.image);
  std::visit([&](const auto& observation) { Show(observation, seen.latency); }, seen.observation);
  feed_.SetFrame(&frame_);
}

void FlightConsole::Show(const LandingObservation& observation, Duration latency) {
  const LandingView& view = std::get<LandingView>(view_);
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

void FlightConsole::SetVision(const ConsoleStatus& status) {
  const std::lock_guard lock(mutex_);
  vision_ = status;
}

}  // namespace kestrel
