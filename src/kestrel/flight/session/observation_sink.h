// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "kestrel/flight/session/flight_report.h"
#include "kestrel/flight/session/observation.h"
#include "kestrel/flight/session/session_event.h"

namespace kestrel {

// Where the results of a session go: a file, a page, a network. A sink of one's own overrides what
// it wants to have. Take is called by the session's threads and must not wait: what is slow belongs
// into an AsynchronousSink.
//
//   class Counter : public ObservationSink {
//    public:
//     void Take(const Observation&) override { ++frames; }
//     int frames = 0;
//   };
class ObservationSink {
 public:
  virtual ~ObservationSink() = default;

  // Whether a frame is worth an Observation. By any thread.
  virtual bool IsWanted() const { return true; }

  // A frame with what it showed. By the vision's thread.
  virtual void Take(const Observation& observation) = 0;
  // The state of the flight, ten times a second. By the session's thread.
  virtual void Take(const FlightReport& /*report*/) {}
  // The team's map, about twice a second. By the session's thread.
  virtual void Take(const TeamReport& /*report*/) {}
  // By any thread.
  virtual void Take(const SessionEvent& /*event*/) {}

  // Writes what is left. Nothing is taken afterwards. Once, by the session's thread.
  virtual void Finish() {}
};

// Gives all to several sinks, in the order in which they were added; they end in the opposite one.
class ObservationSinks : public ObservationSink {
 public:
  ObservationSinks() = default;
  ~ObservationSinks() override {
    while (!sinks_.empty()) sinks_.pop_back();
  }
  ObservationSinks(const ObservationSinks&) = delete;
  ObservationSinks& operator=(const ObservationSinks&) = delete;

  // Before the session begins. Returns the sink.
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
