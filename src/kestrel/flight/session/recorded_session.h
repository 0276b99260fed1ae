// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/flight/session/vision.h"
#include "kestrel/io/bags/open_recording.h"

namespace kestrel {

// A session over a recording: passes all poses and frames in order of time to 'vision' and each
// result to 'sink', by the caller's thread, as fast as they go. 'go_on' is asked before each frame,
// with the number of frames that are done; false stops the session. Returns whether the end was
// reached. The sink is not finished. Throws InputError when the source, the vision or the sink
// does, or when a frame does not have the calibration's size.
bool RunRecording(const OpenedSource& opened, Vision* vision, ObservationSink* sink,
                  const std::function<bool(std::size_t done)>& go_on);

}  // namespace kestrel
