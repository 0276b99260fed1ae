// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kestrel/app/console/messages/console_feed.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/session/flight_report.h"

namespace kestrel {

// Checks the health of a flight's parts once a second. Call it from one thread.
class FlightHealth {
 public:
  // Returns the checks once a second, and nothing in between.
  std::optional<ConsoleHealth> Update(const FlightReport& report, Time now);

  // Rate of the autopilot's packets in the last second, 1/s; nothing in the first second or without
  // an autopilot.
  std::optional<double> link_rate_hz() const { return link_rate_hz_; }

 private:
  ConsoleHealth Compare(const FlightReport& report, double interval_s);

  std::optional<Time> checked_;
  FlightReport last_;
  double last_cpu_s_ = 0;
  std::optional<double> link_rate_hz_;
};

// Returns the vehicle as its autopilot reports it; nothing in a flight without an autopilot.
std::optional<ConsoleVehicle> VehicleOf(const FlightReport& report);

// Watches when the sources of a flight gave something last. Call it from one thread.
class SourceWatch {
 public:
  // A frame that the vision has seen. 'has_pose': where the camera was at that time is known.
  void Look(Time captured, bool has_pose);
  // Returns the ages. The autopilot's is exact to the interval of the reports.
  ConsoleSources Update(const FlightReport& report, Time now);

 private:
  std::optional<Time> frame_, autopilot_, pose_;
  std::uint64_t received_ = 0;  // packets by the last report
};

// Returns the state of a flight and what is in its way, in words for a pilot. 'vision': status from
// the newest frame.
ViewStatus FlightStatus(const FlightReport& report, const ViewStatus& vision);

}  // namespace kestrel
