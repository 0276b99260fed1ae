// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/onboard/flight_program.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "kestrel/base/options.h"
#include "kestrel/base/violations.h"

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

const char* const kStepNames[] = {"capture to arrival", "arrival to pose and detection",
                                  "detection", "capture to message"};

}  // namespace

std::vector<std::string> FlightOptions::Validate() const {
  std::vector<std::string> violations;
  RequireIn(rate_hz, 1, 400, "rate_hz", &violations);
  RequirePositive(source_timeout_s, "source_timeout_s", &violations);
  RequirePositive(autopilot_timeout_s, "autopilot_timeout_s", &violations);
  AddViolations("target", target.Validate(), &violations);
  AddViolations("events", events.Validate(), &violations);
  AddViolations("vision_thread", vision_thread.Validate(), &violations);
  return violations;
}

FlightProgram::FlightProgram(const FlightOptions& options, const TargetTrackerOptions& tracker,
                             const FlightParts& parts,
                             std::function<void(const std::string&)> say)
    : options_(Checked(options)),
      parts_(parts),
      say_(std::move(say)),
      events_(options.events, parts.vision->pose_lead()),
      reporter_(options.target, tracker),
      poses_(kPoses, kPoseGap),
      latency_({std::begin(kStepNames), std::end(kStepNames)}) {}

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
  bool is_over = false;
  if (is_ending_.compare_exchange_strong(is_over, true)) {
    end_ = end;
    is_over_ = true;
  }
}

// --- The capture thread ---

void FlightProgram::Capture() {
  SetUpThisThread("capture", {});
  std::string trouble;
  Time last = Now();
  while (!is_over_) {
    std::optional<Event> event = parts_.source->Next(kPatience);
    if (event && std::holds_alternative<EndOfStream>(*event)) return End(FlightEnd::kSourceEnded);
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
  if (const auto* pose = std::get_if<PoseSample>(&event)) return TakePose(*pose);
  Frame& frame = std::get<Frame>(event);
  latency_.step(kArrival).Add(Now() - frame.time);
  if (parts_.recorder != nullptr) parts_.recorder->Add(frame);
  events_.Push(std::move(frame));
}

void FlightProgram::TakePose(const PoseSample& pose) {
  events_.Push(pose);
  if (parts_.recorder != nullptr) parts_.recorder->Add(pose);
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
    latency_.step(kPose).Add(Now() - frame.time);
    const TrackSnapshot snapshot = parts_.vision->Process(frame);
    latency_.step(kDetection).Add(snapshot.detect_time);
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
  next_message_ = Now();
  while (!is_over_) {
    parts_.connection->Receive(kLinkPatience, [this](const mavlink::Packet& packet, Time received) {
      parts_.autopilot->Handle(packet, received);
    });
    const Time now = Now();
    parts_.autopilot->Tick(now);
    TellTarget(now);
    WatchFlight(now);
  }
}

}  // namespace kestrel
