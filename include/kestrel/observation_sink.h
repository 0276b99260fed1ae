// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The interface of a receiver of results. A sink of your own implements it.
//
// Example:
//   class Counter : public ObservationSink {
//    public:
//     void Take(const Observation&) override { ++frames; }
//     int frames = 0;
//   };

#include "kestrel/flight/session/observation_sink.h"  // IWYU pragma: export
