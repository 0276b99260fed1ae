// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <string>
#include <utility>

#include "kestrel/flight/session/observation_sink.h"

namespace kestrel {

// Passes everything to a sink until that throws: the session then goes on without it. It would end
// the program otherwise, as the session's threads call it.
class GuardedSink : public ObservationSink {
 public:
  // 'notify' is called once, with what the sink has thrown, by the thread that had called it.
  // 'sink' outlives this.
  GuardedSink(ObservationSink* sink, std::function<void(const std::string&)> notify)
      : sink_(sink), notify_(std::move(notify)) {}

  bool IsWanted() const override { return !is_over_ && sink_->IsWanted(); }
  void Take(const Observation& observation) override { TakeAny(observation); }
  void Take(const BrokenFrame& frame) override { TakeAny(frame); }
  void Take(const FlightReport& report) override { TakeAny(report); }
  void Take(const TeamReport& report) override { TakeAny(report); }
  void Take(const SessionEvent& event) override { TakeAny(event); }
  void Finish() override {
    if (is_over_.exchange(true)) return;
    try {
      sink_->Finish();
    } catch (const std::exception& error) {
      notify_(error.what());
    }
  }

 private:
  template <class Value>
  void TakeAny(const Value& value) {
    if (is_over_) return;
    try {
      sink_->Take(value);
    } catch (const std::exception& error) {
      if (!is_over_.exchange(true)) notify_(error.what());
    }
  }

  ObservationSink* sink_;
  std::function<void(const std::string&)> notify_;
  std::atomic<bool> is_over_{false};  // it has failed, or is finished
};

}  // namespace kestrel
