// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/middleware/flight_ros.h"

#include <chrono>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "kestrel/onboard/thread_setup.h"

namespace kestrel {
namespace {

constexpr std::size_t kSeenFrames = 8;  // that wait for the network
constexpr std::size_t kReports = 4;
constexpr Duration kReportPeriod = std::chrono::seconds(1);
constexpr Duration kPatience = std::chrono::milliseconds(200);

}  // namespace

FlightRos::FlightRos(std::unique_ptr<RosResults> results,
                     std::function<void(const std::string&)> tell)
    : results_(std::move(results)),
      tell_(std::move(tell)),
      seen_(kSeenFrames),
      reports_(kReports),
      team_reports_(1),
      next_report_(Now()),
      thread_([this] { Run(); }) {}

FlightRos::~FlightRos() {
  is_over_ = true;
  seen_.Close();
  thread_.join();
}

void FlightRos::See(const Frame& frame, const LandingObservation& observation) {
  seen_.Push({frame, observation});
}

void FlightRos::See(const Frame& frame, const HuntObservation& observation) {
  seen_.Push({frame, observation});
}

void FlightRos::See(const FlightReport& report) {
  const Time now = Now();
  if (now < next_report_) return;
  next_report_ = now + kReportPeriod;
  reports_.Push(report);
}

void FlightRos::SeeTeam(const TeamReport& report) { team_reports_.Push(report); }

void FlightRos::Run() {
  SetUpThisThread("ros", {});
  for (;;) {
    const bool was_over = is_over_;
    const auto seen = seen_.Pop(kPatience);
    while (const auto report = reports_.TryPop()) results_->Publish(*report);
    while (const auto report = team_reports_.TryPop()) results_->Publish(*report);
    if (seen) {
      std::visit([&](const auto& observation) { results_->Publish(seen->frame, observation); },
                 seen->observation);
    } else if (was_over) {
      break;
    }
  }
  results_->Flush();
  if (seen_.dropped() == 0) return;
  tell_(fmt::format("ROS: {} frames are left out: the network is too slow", seen_.dropped()));
}

}  // namespace kestrel
