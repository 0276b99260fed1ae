// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kestrel/console/console_feed.h"
#include "kestrel/console/landing_view.h"
#include "kestrel/pipeline/landing_pipeline.h"

namespace kestrel {

// What became of a frame of a recording.
struct ReplayFrame {
  LandingObservation observation;
  FrameMark mark = FrameMark::kNothing;
  std::optional<double> error_px;  // of the detected centre, where the truth is known
};

// What a run over a recording came to: all frames, in order of time.
struct ReplayResult {
  LandingView view;
  std::vector<ReplayFrame> frames;
  std::string table;  // as `kestrel land` writes landing_detections.csv
};

// The marks of frames whose truth is not known: lost are those without the pattern between two with
// it, false those that the track does not take.
void MarkByTrack(std::vector<ReplayFrame>* frames);

}  // namespace kestrel
