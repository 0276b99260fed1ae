// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/flight/session/flight_report.h"
#include "kestrel/flight/session/observation.h"
#include "kestrel/flight/session/session_event.h"

namespace kestrel {

// Receiver of a session's results: a file, a page, a network. A new sink overrides the functions
// for the results that it needs. The session's threads call Take, which must not wait: slow work
// belongs into an AsynchronousSink. A sink that throws gets nothing any more, and the session goes
// on.
class ObservationSink {
 public:
  virtual ~ObservationSink() = default;

  // True when a frame is worth an Observation. Called by any thread.
  virtual bool IsWanted() const { return true; }

  // A frame with its results. Called by the vision thread.
  virtual void Take(const Observation& observation) = 0;
  // A frame of a recording that cannot be read. Called by the session's thread.
  virtual void Take(const BrokenFrame& /*frame*/) {}
  // State of the flight, ten times a second. Called by the session's thread.
  virtual void Take(const FlightReport& /*report*/) {}
  // The team's map, about twice a second. Called by the session's thread.
  virtual void Take(const TeamReport& /*report*/) {}
  // Called by any thread.
  virtual void Take(const SessionEvent& /*event*/) {}

  // Writes what is left. Called once, by the session's thread; no Take follows.
  virtual void Finish() {}
};

}  // namespace kestrel
