// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "kestrel/flight/session/flight_report.h"
#include "kestrel/flight/session/observation.h"
#include "kestrel/flight/session/session_event.h"

namespace kestrel {

// Receiver of a session's results: a file, a page, a network. A new sink overrides the functions
// for the results that it needs. The session's threads call Take, which must not wait: slow work
// belongs into an AsynchronousSink.
//
// Example:
//   class Counter : public ObservationSink {
//    public:
//     void Take(const Observation&) override { ++frames; }
//     int frames = 0;
//   };
class ObservationSink {
 public:
  virtual ~ObservationSink() = default;

  // True when a frame is worth an Observation. Called by any thread.
  virtual bool IsWanted() const { return true; }

  // A frame with its results. Called by the vision thread.
  virtual void Take(const Observation& observation) = 0;
  // State of the flight, ten times a second. Called by the session's thread.
  virtual void Take(const FlightReport& /*report*/) {}
  // The team's map, about twice a second. Called by the session's thread.
  virtual void Take(const TeamReport& /*report*/) {}
  // Called by any thread.
  virtual void Take(const SessionEvent& /*event*/) {}

  // Writes what is left. Called once, by the session's thread; no Take follows.
  virtual void Finish() {}
};

// Passes everything to several sinks, in the order in which they were added. They finish in the
// opposite order.
class ObservationSinks : public ObservationSink {
 public:
  ObservationSinks() = default;
  ~ObservationSinks() override {
    while (!sinks_.empty()) sinks_.pop_back();
  }
  ObservationSinks(const ObservationSinks&) = delete;
  ObservationSinks& operator=(const ObservationSinks&) = delete;

  // Adds a sink before the session begins. Returns the sink.
  template <class Sink>
  Sink* Add(std::unique_ptr<Sink> sink) {
    Sink* const added = sink.get();
    sinks_.push_back(std::move(sink));
    return added;
  }

  bool IsWanted() const override {
    for (const auto& sink : sinks_) {
      if (sink->IsWanted()) return true;
    }
    return false;
  }
  void Take(const Observation& observation) override { TakeAll(observation); }
  void Take(const FlightReport& report) override { TakeAll(report); }
  void Take(const TeamReport& report) override { TakeAll(report); }
  void Take(const SessionEvent& event) override { TakeAll(event); }
  void Finish() override {
    for (auto sink = sinks_.rbegin(); sink != sinks_.rend(); ++sink) (*sink)->Finish();
  }

 private:
  template <class Value>
  void TakeAll(const Value& value) {
    for (const auto& sink : sinks_) sink->Take(value);
  }

  std::vector<std::unique_ptr<ObservationSink>> sinks_;
};

}  // namespace kestrel
