// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/recorded_session.h"

#include <variant>

#include "kestrel/io/recording/event_source.h"
#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

bool RunRecording(const OpenedSource& opened, Vision* vision, ObservationSink* sink,
                  const std::function<bool(std::size_t done)>& go_on) {
  opened.source->set_on_broken([sink](const BrokenImage& broken) {
    sink->Take(BrokenFrame{broken.name, broken.time, broken.what()});
  });
  RecordingEvents events(opened.source.get(), opened.source->poses(), vision->pose_lead());
  for (std::size_t done = 0;;) {
    const Event event = events.Next();
    if (std::holds_alternative<EndOfStream>(event)) break;
    if (const auto* pose = std::get_if<PoseSample>(&event)) vision->AddPose(*pose);
    const auto* frame = std::get_if<Frame>(&event);
    if (frame == nullptr) continue;
    if (!go_on(done)) return false;
    opened.RequireSize(*frame);
    sink->Take(vision->Process(*frame));
    ++done;
  }
  vision->Finish();
  return true;
}

}  // namespace kestrel
