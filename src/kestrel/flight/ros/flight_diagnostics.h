// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "kestrel/core/base/time.h"
#include "kestrel/flight/onboard/latency_statistics.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/io/ros_messages/result_messages.h"

namespace kestrel {

// Counts of the results that were published.
struct ResultCounts {
  std::uint64_t found = 0;       // images with a detection
  LatencySummary latency;        // from an image's stamp to the publication of its detections
  LatencySummary beyond_detect;  // the same without the time of Detect
  LatencySummary detect;
};

// The rate of something that is counted.
class Rate {
 public:
  // Returns the mean rate (Hz) since the last call, or since the construction.
  double Next(std::uint64_t count);

 private:
  Time time_ = Now();
  std::uint64_t count_ = 0;
};

// Returns a flight's state as a ROS diagnostics message. 'rate_hz': of the images.
DiagnosticStatusMessage DiagnosticsOf(const std::string& name, double rate_hz,
                                      const FlightReport& report, const ResultCounts& counts);

// The same as the message of /diagnostics.
DiagnosticArrayMessage ArrayOf(DiagnosticStatusMessage status, Time stamp);

}  // namespace kestrel
