// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel fly`: camera and autopilot in, landing target out, everything recorded. Status 3 (see
// FlightFailed) when camera or autopilot failed for good.
void AddFlyCommand(CLI::App* app);

// A flight that ended because something failed for good; what() says what.
class FlightFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace kestrel
