// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <variant>

#include "kestrel/foxglove/observation_file.h"
#include "kestrel/onboard/bounded_queue.h"
#include "kestrel/onboard/flight_observer.h"

namespace kestrel {

// A flight as an MCAP file, written by a thread of its own: nobody waits for the disk, and frames
// that it does not keep up with are left out.
class FlightMcap : public FlightObserver {
 public:
  // What is told to the user: that the file cannot be written any more, and how many frames are
  // left out. Called by the thread that writes.
  using Tell = std::function<void(const std::string&)>;

  // As ObservationFile.
  FlightMcap(const std::string& path, bool replace, const CameraIntrinsics& camera,
             std::variant<LandingView, HuntView> view, Tell tell);
  // Writes all that it was given.
  ~FlightMcap() override;
  FlightMcap(const FlightMcap&) = delete;
  FlightMcap& operator=(const FlightMcap&) = delete;

  // Something that happened, in words. By any thread.
  void Say(EventLevel level, const std::string& text) { said_.Push({Now(), level, text}); }

  void See(const Frame& frame, const LandingObservation& observation) override;
  void See(const Frame& frame, const HuntObservation& observation) override;
  void See(const FlightReport&) override {}

 private:
  struct SeenFrame {
    Frame frame;
    Duration latency{};  // from capture until it was processed
    std::variant<LandingObservation, HuntObservation> observation;
  };

  void Run();
  void WriteAll();

  ObservationFile file_;
  Tell tell_;
  BoundedQueue<SeenFrame> seen_;
  BoundedQueue<ConsoleEvent> said_;
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

}  // namespace kestrel
