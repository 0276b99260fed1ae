// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A live camera through GStreamer: a device, an RTSP address or any pipeline.
//
// Example:
//   GstreamerCamera camera("/dev/video0", PaperCamera(), PixelFormat::kGray, {});
//   if (const auto event = camera.Next(std::chrono::seconds(1))) {
//     const auto* frame = std::get_if<Frame>(&*event);
//     if (frame) std::cout << frame->image.size() << "\n";
//   }

#include "kestrel/flight/onboard/gstreamer_camera.h"  // IWYU pragma: export
