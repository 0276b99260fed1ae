// SPDX-License-Identifier: BSD-3-Clause
// A sink of one's own in a flight: plays a recording as it was flown, and writes the detections as
// JSON lines.
//
//   json_lines flight > detections.jsonl
#include <iostream>
#include <memory>

#include "json_lines_sink.h"
#include "kestrel/error.h"
#include "kestrel/session.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: json_lines flight\n";
    return 2;
  }
  try {
    const auto flight = kestrel::OpenLiveSource({.recording = {.sources = {argv[1]}}}, {});
    const auto session = kestrel::MakeSession(flight, kestrel::LandTask({}));
    const auto* const sink = session->sinks().Add(std::make_unique<JsonLinesSink>(&std::cout));
    session->Run();
    return sink->lines() > 0 ? 0 : 1;
  } catch (const kestrel::InputError& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
