// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <variant>

#include "kestrel/foxglove/observation_writer.h"
#include "kestrel/onboard/bounded_queue.h"
#include "kestrel/onboard/flight_observer.h"

namespace kestrel {

// Hands a flight's frames, and what happens in it, to a thread that makes messages of them. Who
// gives never waits: of too many frames the oldest is left out.
class FlightWriter : public FlightObserver {
 public:
  FlightWriter(const FlightWriter&) = delete;
  FlightWriter& operator=(const FlightWriter&) = delete;

  // Something that happened, in words. By any thread.
  void Say(EventLevel level, const std::string& text) {
    if (IsWanted()) said_.Push({Now(), level, text});
  }

  void See(const Frame& frame, const LandingObservation& observation) override;
  void See(const Frame& frame, const HuntObservation& observation) override;
  void See(const FlightReport&) override {}

 protected:
  // 'capacity': of frames that wait.
  explicit FlightWriter(std::size_t capacity);

  // Writes what happened, and the next frame, for which it waits up to 'patience'. False when there
  // was none. Throws InputError as the writer does.
  bool WriteNext(ObservationWriter* writer, Duration patience);
  // No more frames are taken.
  void EndFrames() { seen_.Close(); }
  std::size_t waiting_frames() const { return seen_.size(); }
  std::size_t dropped_frames() const { return seen_.dropped(); }

 private:
  struct SeenFrame {
    Frame frame;
    Duration latency{};  // from capture until it was processed
    std::variant<LandingObservation, HuntObservation> observation;
  };

  // Whether frames are worth a look. By any thread.
  virtual bool IsWanted() const { return true; }

  BoundedQueue<SeenFrame> seen_;
  BoundedQueue<ConsoleEvent> said_;
};

}  // namespace kestrel
