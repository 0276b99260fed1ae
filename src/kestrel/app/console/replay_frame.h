// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/console/console_feed.h"
#include "kestrel/app/console/hunt_view.h"
#include "kestrel/app/console/landing_view.h"

namespace kestrel {

// A frame of a recording as the page shows it, whatever was looked for in it.
struct ReplayFrame {
  Time time;
  FrameMark mark = FrameMark::kNothing;
  std::optional<double> error_px;  // of a detected centre, where the truth is known
  ConsoleSample sample;
  ConsoleStatus status;
  ConsoleMap map;
  std::vector<OverlayShape> shapes;
  std::vector<ConsoleFact> facts;
};

// Marked without the truth: as found where the pattern, or any object, was; as false where the
// track does not take it.
ReplayFrame ReplayFrameOf(const LandingView& view, const LandingObservation& observation);
ReplayFrame ReplayFrameOf(const HuntView& view, const HuntObservation& observation);

// What the map of a hunt has from then on.
struct MapEntry {
  Time since;
  ConsoleMapObject object;
};

// What a run over a recording came to: all frames, in order of time.
struct ReplayResult {
  std::vector<ReplayFrame> frames;
  std::string table;  // as the command writes landing_detections.csv or object_detections.csv
  std::vector<MapEntry> map;
};

// The shapes of a frame, by both runs; 'second' is null where there is one only.
std::vector<OverlayShape> ShapesOf(const ReplayResult& first, const ReplayResult* second,
                                   std::size_t frame);

// Marks as lost what is between two frames with the pattern and has no mark.
void MarkLost(std::vector<ReplayFrame>* frames);

}  // namespace kestrel
