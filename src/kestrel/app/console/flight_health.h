// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "kestrel/app/console/console_feed.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/session/flight_report.h"

namespace kestrel {

// How well a flight's parts do, from one second to the next. By one thread.
class FlightHealth {
 public:
  // The checks once a second; nothing meanwhile.
  std::optional<ConsoleHealth> Update(const FlightReport& report, Time now);

  // Of the autopilot's packets, 1/s, in the last second; nothing before the first and without one.
  std::optional<double> link_rate_hz() const { return link_rate_hz_; }

 private:
  ConsoleHealth Compare(const FlightReport& report, double interval_s);

  std::optional<Time> checked_;
  FlightReport last_;
  double last_cpu_s_ = 0;
  std::optional<double> link_rate_hz_;
};

// The state of a flight, and what is in its way, in words for a pilot. 'vision': what the newest
// frame says.
ConsoleStatus FlightStatus(const FlightReport& report, const ConsoleStatus& vision);

}  // namespace kestrel
