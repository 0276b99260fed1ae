// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>
#include <thread>

#include "kestrel/core/base/bounded_queue.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/session/observation_sink.h"

namespace kestrel {

// The slow part of a sink. All but IsWanted is called by one thread. Nothing here throws.
class SinkWriter {
 public:
  virtual ~SinkWriter() = default;

  // Whether frames are worth keeping for this. By any thread.
  virtual bool IsWanted() const { return true; }

  // 'waiting': frames that wait behind this one.
  virtual void Write(const Observation& observation, std::size_t waiting) = 0;
  virtual void Write(const FlightReport& /*report*/) {}
  virtual void Write(const TeamReport& /*report*/) {}
  virtual void Write(const SessionEvent& /*event*/) {}

  // After all that there was, whether or not it was a frame.
  virtual void Rest(bool /*had_frame*/) {}
  // The end. 'dropped': frames that made room for newer ones.
  virtual void Finish(std::size_t /*dropped*/) {}
};

struct AsynchronousSinkOptions {
  std::string thread_name;
  std::size_t frames = 8;  // that may wait; of more the oldest is dropped
  // Everything but a frame waits no longer than this.
  Duration patience = std::chrono::milliseconds(100);
  int niceness = 0;  // 0 to 19, as of nice(1)
};

// A sink that works in a thread of its own. Who gives never waits: of too many frames the oldest is
// dropped, of reports the newest counts.
class AsynchronousSink : public ObservationSink {
 public:
  AsynchronousSink(AsynchronousSinkOptions options, std::unique_ptr<SinkWriter> writer);
  ~AsynchronousSink() override { Finish(); }
  AsynchronousSink(const AsynchronousSink&) = delete;
  AsynchronousSink& operator=(const AsynchronousSink&) = delete;

  bool IsWanted() const override { return writer_->IsWanted(); }
  void Take(const Observation& observation) override;
  void Take(const FlightReport& report) override { reports_.Push(report); }
  void Take(const TeamReport& report) override { team_reports_.Push(report); }
  void Take(const SessionEvent& event) override { events_.Push(event); }
  // Returns when all that was taken is written.
  void Finish() override;

 private:
  static constexpr std::size_t kEvents = 256;

  void Run();

  AsynchronousSinkOptions options_;
  std::unique_ptr<SinkWriter> writer_;
  BoundedQueue<Observation> observations_;
  BoundedQueue<FlightReport> reports_{1};
  BoundedQueue<TeamReport> team_reports_{1};
  BoundedQueue<SessionEvent> events_{kEvents};
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

}  // namespace kestrel
