// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kestrel/guidance/landing_guidance.h"
#include "kestrel/link/connection.h"
#include "kestrel/onboard/flight_recorder.h"
#include "kestrel/onboard/live_events.h"
#include "kestrel/onboard/live_source.h"
#include "kestrel/onboard/target_reporter.h"
#include "kestrel/pipeline/hunt_pipeline.h"
#include "kestrel/pipeline/landing_pipeline.h"
#include "kestrel/recording/frame.h"
#include "kestrel/team/team_view.h"

namespace kestrel {

// What there is to know of the autopilot and of what it is told.
struct AutopilotState {
  bool is_here = false;     // its heartbeats come
  bool is_landing = false;  // armed, in a mode that lands
  std::optional<GuidancePhase> guidance;
  TargetPhase target = TargetPhase::kSearching;
  ConnectionCounters link;
};

// How a flight is going, beside what its vision sees; all counts are since it began.
struct FlightReport {
  std::string trouble;  // why there are no images; empty as long as they come
  CaptureCounters capture;
  LiveEvents::Counters events;
  int repeated_frames = 0;
  std::optional<AutopilotState> autopilot;
  std::optional<FlightRecorder::Counters> recorder;
};

// What the UAV's team knows, in this UAV's world.
struct TeamReport {
  Time time;  // of the newest frame that is in it
  std::vector<TeamObject> objects;
};

// Looks at a flight while it happens.
class FlightObserver {
 public:
  virtual ~FlightObserver() = default;

  // What a frame showed. By the vision's thread: nothing here may wait. Nobody changes the frame's
  // pixels any more.
  virtual void See(const Frame& frame, const LandingObservation& observation) = 0;
  virtual void See(const Frame& frame, const HuntObservation& observation) = 0;

  // By the thread that the flight was begun in, ten times a second.
  virtual void See(const FlightReport& report) = 0;

  // With a team, by the same thread, twice a second or so.
  virtual void SeeTeam(const TeamReport& /*report*/) {}
};

// Lets several look at a flight; they outlive this.
class FlightObservers : public FlightObserver {
 public:
  // Before the flight begins.
  void Add(FlightObserver* observer) { observers_.push_back(observer); }
  bool empty() const { return observers_.empty(); }

  void See(const Frame& frame, const LandingObservation& observation) override {
    for (FlightObserver* const each : observers_) each->See(frame, observation);
  }
  void See(const Frame& frame, const HuntObservation& observation) override {
    for (FlightObserver* const each : observers_) each->See(frame, observation);
  }
  void See(const FlightReport& report) override {
    for (FlightObserver* const each : observers_) each->See(report);
  }
  void SeeTeam(const TeamReport& report) override {
    for (FlightObserver* const each : observers_) each->SeeTeam(report);
  }

 private:
  std::vector<FlightObserver*> observers_;
};

}  // namespace kestrel
