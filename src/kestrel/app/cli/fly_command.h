// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel fly`: reads camera and autopilot, reports the landing target and records everything. The
// exit status is 3 (see FlightFailed) when camera or autopilot failed for good.
void AddFlyCommand(CLI::App* app);

// Ends a flight because something failed for good; what() says what.
class FlightFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace kestrel
