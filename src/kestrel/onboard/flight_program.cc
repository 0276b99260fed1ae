// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/onboard/flight_program.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string_view>
#include <thread>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "kestrel/base/options.h"
#include "kestrel/base/violations.h"
#include "kestrel/link/mavlink_enums.h"
#include "kestrel/link/ned.h"

namespace kestrel {
namespace {

constexpr Duration kPatience = std::chrono::milliseconds(100);  // of a thread that waits
constexpr Duration kLinkPatience = std::chrono::milliseconds(2);
constexpr Duration kOutputPeriod = std::chrono::milliseconds(50);
constexpr std::size_t kPoses = 512;  // of the link: some seconds
constexpr Duration kPoseGap = std::chrono::milliseconds(500);
constexpr double kFlownHeight_m = 1;  // a UAV that has risen or sunk by this has flown
// A message that is due so soon goes at once, when there is something new to tell.
constexpr double kEarly = 0.5;  // of the period

// ArduPilot's: the delay that it reckons with, and where it takes the camera to be.
constexpr std::string_view kLag = "PLND_LAG", kCameraX = "PLND_CAM_POS_X",
                           kCameraY = "PLND_CAM_POS_Y", kCameraZ = "PLND_CAM_POS_Z";
constexpr std::array kParameters = {kLag, kCameraX, kCameraY, kCameraZ};
constexpr double kDefaultLag_s = 0.02;

}  // namespace

std::vector<std::string> FlightOptions::Validate() const {
  std::vector<std::string> violations;
  RequireIn(rate_hz, 1, 400, "rate_hz", &violations);
  RequireIn(link_delay_s, -1, 2, "link_delay_s", &violations);
  RequirePositive(source_timeout_s, "source_timeout_s", &violations);
  RequirePositive(autopilot_timeout_s, "autopilot_timeout_s", &violations);
  AddViolations("target", target.Validate(), &violations);
  AddViolations("messages", messages.Validate(), &violations);
  AddViolations("events", events.Validate(), &violations);
  AddViolations("vision_thread", vision_thread.Validate(), &violations);
  return violations;
}

FlightProgram::FlightProgram(const FlightOptions& options, const TargetTrackerOptions& tracker,
                             const FlightParts& parts, std::function<void(const std::string&)> say)
    : options_(Checked(options)),
      parts_(parts),
      say_(std::move(say)),
      events_(options.events, parts.vision->pose_lead()),
      reporter_(options.target, tracker),
      poses_(kPoses, kPoseGap),
      latency_({"capture to arrival", "capture to vision", "detection", "capture to message"}) {}

FlightEnd FlightProgram::Run(const std::function<bool()>& is_stopped) {
  std::vector<std::thread> threads;
  threads.emplace_back([this] { See(); });
  threads.emplace_back([this] { Capture(); });
  threads.emplace_back([this] { WriteResults(); });
  if (parts_.connection != nullptr) threads.emplace_back([this] { Communicate(); });
  while (!is_over_) {
    if (is_stopped()) End(FlightEnd::kStopped);
    std::this_thread::sleep_for(kPatience);
  }
  events_.Close();
  for (std::thread& thread : threads) thread.join();
  return end_;
}

// The first reason counts.
void FlightProgram::End(FlightEnd end) {
  std::call_once(ended_, [&] {
    end_ = end;
    is_over_ = true;
  });
}

// --- The capture thread ---

void FlightProgram::Capture() {
  SetUpThisThread("capture", {});
  std::string trouble;
  Time last = Now();
  while (!is_over_) {
    std::optional<Event> event = parts_.source->Next(kPatience);
    if (event && std::holds_alternative<EndOfStream>(*event)) {
      // The last frame may still wait for its pose.
      std::this_thread::sleep_for(DurationFromSeconds(options_.events.pose_wait_s) + kPatience);
      return End(FlightEnd::kSourceEnded);
    }
    if (event) {
      last = Now();
      Take(std::move(*event));
    }
    if (const std::string error = parts_.source->error(); error != trouble) {
      say_(error.empty() ? "the camera is back" : error);
      trouble = error;
    }
    if (ToSeconds(Now() - last) < options_.source_timeout_s) continue;
    say_(fmt::format("no image for {:g} s: the flight's vision ends", options_.source_timeout_s));
    return End(FlightEnd::kFailed);
  }
}

void FlightProgram::Take(Event event) {
  if (const auto* pose = std::get_if<PoseSample>(&event)) {
    source_pose_.Set(*pose);
    return TakePose(*pose);
  }
  auto& frame = std::get<Frame>(event);
  latency_.step(kArrival).Add(Now() - frame.time);
  if (parts_.recorder != nullptr) {
    parts_.recorder->AddFrame(frame, parts_.truth ? parts_.truth(frame) : std::nullopt);
  }
  events_.Push(std::move(frame));
}

void FlightProgram::TakePose(const PoseSample& pose) {
  events_.Push(pose);
  if (parts_.recorder != nullptr) parts_.recorder->AddPose(pose);
}

// --- The vision thread ---

void FlightProgram::See() {
  if (const std::string problem = SetUpThisThread("vision", options_.vision_thread);
      !problem.empty()) {
    say_(problem);
  }
  for (;;) {
    const Event event = events_.Next();
    if (std::holds_alternative<EndOfStream>(event)) return;
    if (const auto* pose = std::get_if<PoseSample>(&event)) {
      parts_.vision->AddPose(*pose);
      continue;
    }
    const auto& frame = std::get<Frame>(event);
    latency_.step(kVision).Add(Now() - frame.time);
    const TrackSnapshot snapshot = parts_.vision->Process(frame);
    latency_.step(kDetection).Add(snapshot.detect_time);
    frames_ = snapshot.frames;
    detections_ = snapshot.detections;
    track_.Set(snapshot);
  }
}

// --- The output thread ---

void FlightProgram::WriteResults() {
  SetUpThisThread("output", {});
  bool is_written = true;
  while (!is_over_) {
    std::this_thread::sleep_for(kOutputPeriod);
    if (parts_.vision->WriteResults() || !is_written) continue;
    is_written = false;
    say_("the results cannot be written any more: is the disk full? The flight goes on");
  }
  parts_.vision->WriteResults();
}

// --- The link thread ---

void FlightProgram::Communicate() {
  SetUpThisThread("link", {});
  due_ = heard_ = Now();
  while (!is_over_) {
    parts_.connection->Receive(kLinkPatience, [this](const mavlink::Packet& packet, Time received) {
      parts_.autopilot->Handle(packet, received);
    });
    if (parts_.source_has_poses) poses_.Add(source_pose_.Get());  // once: another is out of order
    const Time now = Now();
    parts_.autopilot->Tick(now);
    TellTarget(now);
    WatchFlight(now);
  }
}

void FlightProgram::TakeAutopilotPose(const PoseSample& pose) {
  newest_pose_ = pose;
  if (parts_.source_has_poses) return;
  poses_.Add(pose);
  TakePose(pose);
}

// At a steady rate, and at once what a new frame has shown.
void FlightProgram::TellTarget(Time now) {
  const TrackSnapshot& track = track_.Get();
  const Duration period = DurationFromSeconds(1 / options_.rate_hz);
  const bool is_news = track.captured != told_frame_;
  if (now <
      due_ - (is_news ? std::chrono::duration_cast<Duration>(kEarly * period) : Duration::zero())) {
    return;
  }
  due_ = std::max(due_ + period, now + period / 2);
  Autopilot& autopilot = *parts_.autopilot;
  if (!autopilot.is_here()) return;
  WantParameters();
  const LinkProfile profile = parts_.profile.value_or(ProfileFor(autopilot.kind()));
  auto report = reporter_.Report(now, UntilUse(), track, poses_);
  SayPhase();
  // PX4's target estimator filters by itself, and corrects the UAV's velocity by what it is told:
  // a track, which has the UAV's own estimate in it, would lead it in a circle. It gets what each
  // frame shows, with its time.
  if (report && profile != LinkProfile::kArduPilot) WarnOfSpeed(report->velocity_in_world);
  if (profile == LinkProfile::kPx4Vte) report = is_news ? track.sighting : std::nullopt;
  told_frame_ = track.captured;
  if (!report) return;
  report->size_m = parts_.pattern_size_m;
  if (profile == LinkProfile::kArduPilot) {
    report->position_in_world -= report->world_from_body.rotation * CameraOfArduPilot();
  }
  if (!SendTarget(profile, options_.messages, *report, autopilot, now, parts_.connection)) return;
  messages_.fetch_add(1, std::memory_order_relaxed);
  if (is_news) latency_.step(kMessage).Add(Now() - track.captured);
}

// What an autopilot does not have it is not asked for.
void FlightProgram::WantParameters() {
  if (asked_parameters_ || parts_.autopilot->kind() != AutopilotKind::kArduPilot) return;
  asked_parameters_ = true;
  for (const std::string_view parameter : kParameters) {
    parts_.autopilot->parameters().Want(parameter);
  }
}

// Where ArduPilot takes the camera to be (FLU): it adds that to what it is told, which is measured
// from the body's origin.
Eigen::Vector3d FlightProgram::CameraOfArduPilot() const {
  const ParameterReader& parameters = parts_.autopilot->parameters();
  const auto in_frd = [&](std::string_view name) { return parameters.Find(name).value_or(0); };
  return FluFromFrd({in_frd(kCameraX), in_frd(kCameraY), in_frd(kCameraZ)});
}

// The link takes some time; and ArduPilot takes a target for one that was seen some time ago.
Duration FlightProgram::UntilUse() const {
  const Autopilot& autopilot = *parts_.autopilot;
  const Duration delay = options_.link_delay_s >= 0 ? DurationFromSeconds(options_.link_delay_s)
                                                    : autopilot.time_sync().round_trip() / 2;
  if (autopilot.kind() != AutopilotKind::kArduPilot) return delay;
  return delay - DurationFromSeconds(autopilot.parameters().Find(kLag).value_or(kDefaultLag_s));
}

// Said once, when it is sure.
void FlightProgram::WarnOfSpeed(const Eigen::Vector3d& velocity) {
  constexpr double kStanding_mps = 1;
  constexpr int kSure = 50;  // messages in a row
  const double speed_mps = velocity.head<2>().norm();
  moving_messages_ = speed_mps > kStanding_mps ? moving_messages_ + 1 : 0;
  if (moving_messages_ != kSure || is_warned_) return;
  is_warned_ = true;
  say_(
      fmt::format("the pattern moves at {:.1f} m/s: PX4's own precision landing is for patterns "
                  "that stand, and trails behind this one",
                  speed_mps));
  parts_.autopilot->Announce(mavlink::kSeverityWarning,
                             "Kestrel: the pattern moves, PX4 will not land on it");
}

// Tells the user and the ground station when the target is found, lost, stood on.
void FlightProgram::SayPhase() {
  const TargetPhase phase = reporter_.phase();
  phase_ = phase;
  height_m_ = reporter_.height_m();
  if (phase == said_phase_) return;
  said_phase_ = phase;
  std::string text;
  std::uint8_t severity = mavlink::kSeverityInfo;
  switch (phase) {
    case TargetPhase::kSearching:
      return;
    case TargetPhase::kFound:
      text = fmt::format("pattern found, {:.1f} m below", reporter_.height_m());
      break;
    case TargetPhase::kLost:
      text = "pattern lost";
      severity = mavlink::kSeverityWarning;
      break;
    case TargetPhase::kContact:
      text = "on the pattern";
      break;
  }
  say_(text);
  parts_.autopilot->Announce(severity, "Kestrel: " + text);
}

// And when the autopilot begins to land by it.
void FlightProgram::SayLanding() {
  const bool is_landing = parts_.autopilot->is_landing_mode() && parts_.autopilot->is_armed();
  if (is_landing && !was_landing_) {
    parts_.autopilot->Announce(mavlink::kSeverityInfo, fmt::format("Kestrel: landing, pattern {}",
                                                                   ToString(reporter_.phase())));
  }
  was_landing_ = is_landing;
}

void FlightProgram::WatchFlight(Time now) {
  if (parts_.autopilot->is_here()) {
    heard_ = now;
    SayLanding();
    return WatchLanding();
  }
  if (ToSeconds(now - heard_) < options_.autopilot_timeout_s) return;
  say_(fmt::format("no heartbeat of the autopilot for {:g} s", options_.autopilot_timeout_s));
  End(FlightEnd::kFailed);
}

// It has landed when it is disarmed after it was in the air.
void FlightProgram::WatchLanding() {
  const Autopilot& autopilot = *parts_.autopilot;
  const double z = newest_pose_ ? newest_pose_->world_from_body.translation.z() : 0;
  if (!autopilot.is_armed()) {
    if (was_armed_ && has_flown_) return End(FlightEnd::kLanded);
    was_armed_ = has_flown_ = false;
    return;
  }
  if (!was_armed_) armed_z_m_ = z;
  was_armed_ = true;
  const LandedState state = autopilot.landed_state();
  has_flown_ = has_flown_ || std::abs(z - armed_z_m_) > kFlownHeight_m ||
               state == LandedState::kInAir || state == LandedState::kLanding;
}

// --- In words ---

std::string FlightProgram::State() const {
  const CaptureCounters capture = parts_.source->counters();
  std::string state = fmt::format("{} frames, {} with the target", frames_, detections_);
  if (capture.missed > 0) state += fmt::format(", {} missed", capture.missed);
  if (parts_.autopilot == nullptr) return state;
  state += fmt::format("; target {}", ToString(phase_));
  if (phase_ == TargetPhase::kFound) state += fmt::format(", {:.1f} m below", height_m_.load());
  return state + fmt::format("; {} messages sent", messages_);
}

std::string FlightProgram::Summary() const {
  const LiveEvents::Counters events = events_.counters();
  const CaptureCounters capture = parts_.source->counters();
  std::string summary = fmt::format("{} frames, {}", frames_, parts_.vision->Found());
  summary += fmt::format(
      "; {} missed by the camera, {} dropped before the vision, {} without "
      "a pose in time\n",
      capture.missed, events.dropped_frames, events.unposed_frames);
  summary += latency_.InWords();
  if (parts_.connection == nullptr) return summary;
  const ConnectionCounters link = parts_.connection->counters();
  summary += fmt::format("{} targets sent; {} packets received, {} sent, {} not sent; {} damaged\n",
                         messages_, link.received, link.sent, link.unsent, link.bad_checksums);
  return summary;
}

}  // namespace kestrel
