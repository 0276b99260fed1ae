// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <variant>

#include "kestrel/middleware/ros_results.h"
#include "kestrel/onboard/bounded_queue.h"
#include "kestrel/onboard/flight_observer.h"

namespace kestrel {

// Publishes a flight's results by a thread of its own: nobody waits for the network, and frames
// that it does not keep up with are left out.
class FlightRos : public FlightObserver {
 public:
  // 'tell', at the end: how many frames are left out, where any is.
  FlightRos(std::unique_ptr<RosResults> results, std::function<void(const std::string&)> tell);
  ~FlightRos() override;
  FlightRos(const FlightRos&) = delete;
  FlightRos& operator=(const FlightRos&) = delete;

  void See(const Frame& frame, const LandingObservation& observation) override;
  void See(const Frame& frame, const HuntObservation& observation) override;
  void See(const FlightReport& report) override;
  void SeeTeam(const TeamReport& report) override;

 private:
  struct SeenFrame {
    Frame frame;
    std::variant<LandingObservation, HuntObservation> observation;
  };

  void Run();

  std::unique_ptr<RosResults> results_;
  std::function<void(const std::string&)> tell_;
  BoundedQueue<SeenFrame> seen_;
  BoundedQueue<FlightReport> reports_;
  BoundedQueue<TeamReport> team_reports_;
  Time next_report_;
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

}  // namespace kestrel
