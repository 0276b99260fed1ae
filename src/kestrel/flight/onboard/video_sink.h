// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "kestrel/flight/onboard/video_server.h"
#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/flight/session/vision.h"

namespace kestrel {

// Images a second of a video, at most.
inline constexpr double kVideoRate_hz = 15;

// Returns a sink that shows the images of the first camera with the results and their age drawn in,
// as long as somebody looks. It draws the newest one in a thread of its own, and leaves out what it
// is too late for. 'server' must outlive it; 'notify' receives why there are no images any more.
std::unique_ptr<ObservationSink> MakeVideoSink(VideoServer* server, ObservationPainter painter,
                                               std::function<void(const std::string&)> notify);

}  // namespace kestrel
