// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Frames and poses of a recording as one stream in order of time.
//
// Example:
//   const auto source = OpenSource({"flight"});
//   RecordingEvents events(source.get(), source->poses(), /*lead=*/Duration::zero());
//   for (Event event = events.Next(); !std::holds_alternative<EndOfStream>(event);
//        event = events.Next()) {
//     if (const auto* frame = std::get_if<Frame>(&event)) std::cout << frame->name << "\n";
//   }

#include "kestrel/io/recording/event_source.h"  // IWYU pragma: export
