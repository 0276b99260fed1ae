// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A live source by its name, as the command `kestrel fly` takes it.
//
// Example:
//   const OpenedLiveSource camera = OpenLiveSource(
//       {.recording = {.sources = {"/dev/video0"}, .camera = "camera.yaml"}}, {});
//   while (const auto event = camera.source->Next(std::chrono::seconds(1))) {
//     if (const auto* frame = std::get_if<Frame>(&*event)) std::cout << frame->name << "\n";
//   }

#include "kestrel/flight/onboard/open_live_source.h"  // IWYU pragma: export
