// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "kestrel/flight/session/guarded_sink.h"
#include "kestrel/flight/session/observation_sink.h"

namespace kestrel {

// Effect of an error that a sink throws.
enum class SinkErrors {
  kLeaveOut,  // a flight goes on: the sink is left out, and the others get an event that says so
  kThrow,     // a session over a recording ends: its caller gets the error
};

// Passes everything to several sinks, in the order in which they were added. They finish in the
// opposite order.
class ObservationSinks : public ObservationSink {
 public:
  explicit ObservationSinks(SinkErrors errors = SinkErrors::kLeaveOut) : errors_(errors) {}
  ~ObservationSinks() override {
    while (!sinks_.empty()) sinks_.pop_back();
  }
  ObservationSinks(const ObservationSinks&) = delete;
  ObservationSinks& operator=(const ObservationSinks&) = delete;

  // Adds a sink before the session begins. Returns the sink.
  template <class Sink>
  Sink* Add(std::unique_ptr<Sink> sink) {
    Sink* const added = sink.get();
    sinks_.push_back(std::make_unique<OwnedSink>(
        std::move(sink), errors_, [this](const std::string& error) { Notify(error); }));
    return added;
  }

  // The last error of a sink that was left out; empty: all work. Any thread may call it.
  std::string failure() const {
    const std::lock_guard lock(mutex_);
    return failure_;
  }

  bool IsWanted() const override {
    for (const auto& sink : sinks_) {
      if (sink->used->IsWanted()) return true;
    }
    return false;
  }
  void Take(const Observation& observation) override { TakeAll(observation); }
  void Take(const BrokenFrame& frame) override { TakeAll(frame); }
  void Take(const FlightReport& report) override { TakeAll(report); }
  void Take(const TeamReport& report) override { TakeAll(report); }
  void Take(const SessionEvent& event) override { TakeAll(event); }
  void Finish() override {
    for (auto sink = sinks_.rbegin(); sink != sinks_.rend(); ++sink) (*sink)->used->Finish();
  }

 private:
  struct OwnedSink {
    OwnedSink(std::unique_ptr<ObservationSink> owned_sink, SinkErrors errors,
              std::function<void(const std::string&)> notify)
        : owned(std::move(owned_sink)), guarded(owned.get(), std::move(notify)) {
      if (errors == SinkErrors::kLeaveOut) used = &guarded;
    }

    std::unique_ptr<ObservationSink> owned;
    GuardedSink guarded;
    ObservationSink* used = owned.get();
  };

  template <class Value>
  void TakeAll(const Value& value) {
    for (const auto& sink : sinks_) sink->used->Take(value);
  }

  void Notify(const std::string& error) {
    {
      const std::lock_guard lock(mutex_);
      failure_ = error;
    }
    TakeAll(SessionEvent{
        Now(), EventLevel::kError,
        "a sink of the results has failed: " + error + ": the flight goes on without it"});
  }

  SinkErrors errors_;
  mutable std::mutex mutex_;
  std::string failure_;  // guarded by mutex_
  std::vector<std::unique_ptr<OwnedSink>> sinks_;
};

}  // namespace kestrel
