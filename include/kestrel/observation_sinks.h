// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Several sinks as one, with one rule for the errors that they throw.
//
// Example:
//   std::unique_ptr<ObservationSink> first;  // yours
//   ObservationSinks sinks;
//   sinks.Add(std::move(first));
//   sinks.Take(Observation());  // a session does
//   sinks.Finish();

#include "kestrel/flight/session/observation_sinks.h"  // IWYU pragma: export
