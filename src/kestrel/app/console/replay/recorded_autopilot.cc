// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/recorded_autopilot.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/console/flight/flight_health.h"
#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/telemetry_log.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/flight/session/autopilot_report.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"

namespace kestrel {
namespace {

using Log = std::span<const std::uint8_t>;

// A packet so far from the images has a damaged time.
constexpr Duration kMargin = std::chrono::minutes(10);

// A recorded autopilot answers no requests: they are discarded.
class NoTransport : public Transport {
 public:
  std::size_t Receive(Duration /*timeout*/, std::span<std::uint8_t> /*buffer*/) override {
    return 0;
  }
  bool Send(std::span<const std::uint8_t> /*frame*/) override { return false; }
  bool is_connected() const override { return false; }
  bool has_datagrams() const override { return true; }
  std::array<int, 2> files() const override { return {-1, -1}; }
};

std::optional<std::string> FindLog(const std::vector<std::string>& sources) {
  if (sources.size() != 1) return std::nullopt;
  const auto root = FindEurocRoot(sources.front());
  if (!root) return std::nullopt;
  const auto file = (std::filesystem::path(*root) / ".." / "mavlink.tlog").lexically_normal();
  return std::filesystem::exists(file) ? std::optional(file.string()) : std::nullopt;
}

bool IsNear(Time time, Time begin, Time end) {
  return time >= begin - kMargin && time <= end + kMargin;
}

// Returns the time of the recording minus UTC. Kestrel's questions for the autopilot's clock have
// both. The middle one decides, as the time of any may be damaged.
std::optional<Duration> OffsetOf(Log log, Time begin, Time end) {
  constexpr std::uint8_t kAutopilotComponent = 1;  // its questions have its own time
  std::vector<Duration> offsets;
  mavlink::ReadTelemetryLog(log, [&](const mavlink::Packet& packet, std::int64_t utc_us) {
    const auto question = packet.As<mavlink::Timesync>();
    if (!question || question->tc1 != 0 || packet.component == kAutopilotComponent) return;
    const Time requested = TimeFromNanoseconds(question->ts1);
    if (!IsNear(requested, begin, end)) return;
    offsets.push_back(requested.time_since_epoch() - std::chrono::microseconds(utc_us));
  });
  if (offsets.empty()) return std::nullopt;
  const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
  std::nth_element(offsets.begin(), middle, offsets.end());
  return *middle;
}

// The state before the first heartbeat and after the end of the log: nothing is known.
ConsoleVehicle NotKnown() { return {{{"mode", "not checked", "not recorded"}}, {}, ""}; }

// Follows an autopilot by its recorded packets as a flight does by those of the link.
class Follower {
 public:
  Follower()
      : connection_("", {}, {}, std::make_unique<NoTransport>()),
        autopilot_({}, &connection_,
                   {.pose = {},
                    .true_pose = {},
                    .event = [this](const AutopilotEvent& event) { Keep(event); },
                    .text =
                        [this](std::uint8_t severity, std::string_view text) {
                          Add(LevelOf(severity), WordsOfAutopilot(text));
                        },
                    .gimbal = {}}) {
    report_.autopilot.emplace();
    found_.states.push_back({Time::min(), NotKnown()});
  }

  void Take(const mavlink::Packet& packet, Time time) {
    constexpr Duration kLookEvery = std::chrono::milliseconds(50);
    now_ = std::max(now_, time);
    autopilot_.Handle(packet, now_);
    if (now_ - looked_ < kLookEvery) return;
    looked_ = now_;
    autopilot_.Tick(now_);
    Look();
  }

  RecordedAutopilot Finish() {
    constexpr Duration kRest = std::chrono::seconds(1);
    if (found_.states.size() > 1) found_.states.push_back({now_ + kRest, NotKnown()});
    return std::move(found_);
  }

 private:
  // Those that follow are about the recording program's own link.
  void Keep(const AutopilotEvent& event) {
    if (event.kind <= AutopilotEventKind::kFailsafe) Add(EventLevel::kInfo, event.text);
  }
  void Add(EventLevel level, std::string text) {
    found_.events.push_back({now_, level, std::move(text)});
  }

  void Look() {
    UpdateState(autopilot_, now_, &*report_.autopilot);
    if (report_.autopilot->mode.empty()) return;
    ConsoleVehicle vehicle = *VehicleOf(report_);
    if (!autopilot_.is_here()) vehicle.facts.resize(1);  // the rest is old
    if (vehicle == found_.states.back().vehicle) return;
    found_.states.push_back({now_, std::move(vehicle)});
  }

  Connection connection_;
  Autopilot autopilot_;
  FlightReport report_;
  RecordedAutopilot found_;
  Time now_{};
  Time looked_{};
};

RecordedAutopilot Follow(Log log, const std::string& file, Time begin, Time end) {
  const auto offset = OffsetOf(log, begin, end);
  if (!offset) {
    RecordedAutopilot nothing;
    nothing.fault = fmt::format(
        "{}: has no TIMESYNC of Kestrel from the time of the images: it is not shown", file);
    return nothing;
  }
  Follower follower;
  const std::size_t damaged =
      mavlink::ReadTelemetryLog(log, [&](const mavlink::Packet& packet, std::int64_t utc_us) {
        const Time time(std::chrono::microseconds(utc_us) + *offset);
        if (IsNear(time, begin, end)) follower.Take(packet, time);
      });
  RecordedAutopilot found = follower.Finish();
  if (damaged > 0) {
    found.fault = fmt::format("{}: {} of {} bytes are damaged or cut off: the rest is shown", file,
                              damaged, log.size());
  }
  return found;
}

}  // namespace

const ConsoleVehicle& RecordedAutopilot::At(Time time) const {
  const auto next =
      std::upper_bound(states.begin(), states.end(), time,
                       [](Time wanted, const State& state) { return wanted < state.since; });
  return (next == states.begin() ? next : std::prev(next))->vehicle;
}

RecordedAutopilot ReadRecordedAutopilot(const std::vector<std::string>& sources, Time begin,
                                        Time end) {
  const auto file = FindLog(sources);
  if (!file) return {};
  const std::string text = ReadFile(*file);
  RecordedAutopilot found =
      Follow({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, *file, begin, end);
  if (!found.fault.empty()) {
    found.events.insert(found.events.begin(), {begin, EventLevel::kWarning, found.fault});
  }
  return found;
}

}  // namespace kestrel
