// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

#include <CLI/CLI.hpp>

#include "kestrel/app/cli/fly_arguments.h"
#include "kestrel/flight/session/flight_end.h"

namespace kestrel {

// `kestrel fly`: reads camera and autopilot, reports the landing target and records everything. Its
// callback throws BadFlightEnd when the flight did not end as it should.
void AddFlyCommand(CLI::App* app);

// Makes flights with these arguments, one after the other, until the user interrupts: a show.
// Throws InputError as the command does.
void FlyUntilInterrupted(FlyArguments arguments);

// Arguments that are valid alone but not together; what() is one line.
class WrongUsage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A flight that did not end on the pattern; what() is its end in words.
class BadFlightEnd : public std::runtime_error {
 public:
  explicit BadFlightEnd(const FlightEnd& end)
      : std::runtime_error(InWords(end)), status_(ExitStatus(end)) {}

  int status() const { return status_; }  // exit status of the program

 private:
  int status_;
};

}  // namespace kestrel
