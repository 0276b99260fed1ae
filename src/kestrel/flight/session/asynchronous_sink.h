// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "kestrel/core/base/bounded_queue.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/session/observation_sink.h"

namespace kestrel {

// The slow part of a sink. All functions but IsWanted are called by one thread. After the first one
// that throws none is called any more.
class SinkWriter {
 public:
  virtual ~SinkWriter() = default;

  // True when frames are worth keeping for this writer. Called by any thread.
  virtual bool IsWanted() const { return true; }

  // 'waiting': number of frames that wait behind this one.
  virtual void Write(const Observation& observation, std::size_t waiting) = 0;
  virtual void Write(const FlightReport& /*report*/) {}
  virtual void Write(const TeamReport& /*report*/) {}
  virtual void Write(const SessionEvent& /*event*/) {}

  // Called after everything that was waiting is written. 'had_frame': a frame was among it.
  virtual void Rest(bool /*had_frame*/) {}
  // The end. 'dropped': number of frames that were dropped for newer ones.
  virtual void Finish(std::size_t /*dropped*/) {}
};

struct AsynchronousSinkOptions {
  std::string thread_name;
  std::size_t frames = 8;  // that may wait; beyond that the oldest is dropped
  // Longest time that everything but a frame waits.
  Duration patience = std::chrono::milliseconds(100);
  // Longest time for what waits at the end, beyond a Write that is running: the rest is dropped.
  Duration last_patience = std::chrono::seconds(5);
  int niceness = 0;  // 0 to 19, as in nice(1)
  // Receives what the writer has thrown, from the sink's thread; empty: nobody does.
  std::function<void(const std::string&)> notify = {};
};

// A sink that works in a thread of its own. The caller never waits: when too many frames wait the
// oldest is dropped; of reports only the newest is kept. When the writer throws, the sink takes
// nothing any more.
class AsynchronousSink : public ObservationSink {
 public:
  AsynchronousSink(AsynchronousSinkOptions options, std::unique_ptr<SinkWriter> writer);
  ~AsynchronousSink() override { Finish(); }
  AsynchronousSink(const AsynchronousSink&) = delete;
  AsynchronousSink& operator=(const AsynchronousSink&) = delete;

  bool IsWanted() const override { return !has_failed_ && writer_->IsWanted(); }
  void Take(const Observation& observation) override;
  void Take(const FlightReport& report) override { reports_.Push(report); }
  void Take(const TeamReport& report) override { team_reports_.Push(report); }
  void Take(const SessionEvent& event) override { events_.Push(event); }
  // Returns when everything that was taken is written, or the time for it is over.
  void Finish() override;

 private:
  static constexpr std::size_t kEvents = 256;

  void Run();
  void WriteAll();
  bool WriteWaiting();
  std::size_t DropWaiting();

  AsynchronousSinkOptions options_;
  std::unique_ptr<SinkWriter> writer_;
  BoundedQueue<Observation> observations_;
  BoundedQueue<FlightReport> reports_{1};
  BoundedQueue<TeamReport> team_reports_{1};
  BoundedQueue<SessionEvent> events_{kEvents};
  std::atomic<bool> is_over_{false};
  std::atomic<bool> has_failed_{false};
  std::thread thread_;
};

}  // namespace kestrel
