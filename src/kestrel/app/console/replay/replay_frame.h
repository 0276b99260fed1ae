// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/console/messages/console_feed.h"
#include "kestrel/app/views/task_view.h"
#include "kestrel/flight/session/observation.h"

namespace kestrel {

// A frame as the page shows it, of any task.
struct ReplayFrame : ViewFrame {
  FrameMark mark = FrameMark::kNothing;
  std::optional<double> error_px = {};  // from the true centre, where it is known
};

// Makes a frame without using the truth. Its mark is kFound when the pattern, or any object, was
// found, and kFalse when the track rejects the pattern. 'observation': of the view's kind.
ReplayFrame ReplayFrameOf(const TaskView& view, const Observation& observation);

// An object of a hunt's map and the time at which the map gets it.
struct MapEntry {
  Time since;
  ViewMapObject object;
};

// Result of a run over a recording: all frames in order of time.
struct ReplayResult {
  std::vector<ReplayFrame> frames;
  std::string table;  // text of landing_detections.csv or object_detections.csv
  std::vector<MapEntry> map;
};

// Returns the shapes of a frame by both runs; 'second' is null when there is only one run.
std::vector<OverlayShape> ShapesOf(const ReplayResult& first, const ReplayResult* second,
                                   std::size_t frame);

// Returns the index of the first frame with something found, 0 where nothing was.
std::size_t FirstFound(const std::vector<ReplayFrame>& frames);

// Marks as lost all unmarked frames between the first and the last frame with a mark.
void MarkLost(std::vector<ReplayFrame>* frames);

}  // namespace kestrel
