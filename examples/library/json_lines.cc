// SPDX-License-Identifier: BSD-3-Clause
// A sink of one's own in a flight: plays a recording as it was flown, and writes the detections as
// JSON lines.
//
//   json_lines flight > detections.jsonl
#include <iostream>

#include "json_lines_sink.h"
#include "kestrel/error.h"
#include "kestrel/live_session.h"
#include "kestrel/open_source.h"
#include "kestrel/realtime_replay.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: json_lines flight\n";
    return 2;
  }
  try {
    const auto open = [&] { return kestrel::OpenSource({argv[1]}); };
    kestrel::LiveSessionParts parts;
    parts.calibration = open()->calibration().value();
    const kestrel::Duration offset =
        parts.calibration.clock_offset.value_or(kestrel::Duration::zero());
    kestrel::RealtimeReplay replay(open, offset, /*is_looped=*/false);
    JsonLinesSink sink(&std::cout);
    parts.source = &replay;
    parts.has_poses = true;
    parts.sink = &sink;
    kestrel::LiveSession session(parts);
    session.Run([] { return false; });
    sink.Finish();
    return sink.lines() > 0 ? 0 : 1;
  } catch (const kestrel::InputError& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
