// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A sink with a thread and a bounded queue of its own, for results that are slow to write.
//
// Example:
//   struct Printer : SinkWriter {
//     void Write(const Observation& observation, std::size_t waiting) override {
//       std::cout << observation.frame.name << ", " << waiting << " wait\n";
//     }
//   };
//   ObservationSinks sinks;
//   sinks.Add(std::make_unique<AsynchronousSink>(AsynchronousSinkOptions{.thread_name = "printer"},
//                                                std::make_unique<Printer>()));

#include "kestrel/flight/session/asynchronous_sink.h"  // IWYU pragma: export
