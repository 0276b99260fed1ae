// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "kestrel/app/evaluation/object_comparison.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// An annotated disc of the real frame, and the detection nearest to it.
struct RealDisc {
  std::string color;
  std::string found_as;  // class; empty: nothing is within 20 px
  double center_error_px = 0;
};

struct RealFrameScore {
  std::vector<RealDisc> discs;
  int single = 0;  // detections, without those that may be several discs
  int merged = 0;
};

// 'folder': hunt_real, a screenshot without calibration; its plot and legend are painted over.
RealFrameScore ScoreRealFrame(const std::string& folder);

// Digits that are right, of the detections of cuboids wholly in view; a 6 that is upside down is a
// 9.
struct DigitScore {
  int right = 0;
  int count = 0;
};

struct HuntScore {
  std::vector<ObjectComparison> comparisons;
  // Of the objects found (px): those that had to be found by shape ("disc, wanted") and together
  // ("all, wanted"), and "cut off, hidden or small".
  std::map<std::string, std::vector<double>> center_errors_px;
  DigitScore digits;
  DigitScore near_digits;  // of cuboids at most 3 m away
};

// A recording with its truth through HuntPipeline: clock offset and mount are given as scene.yaml
// has them, as a calibration would, and the rolling shutter's readout of 25 ms.
HuntScore ScoreHunt(const std::string& folder, const ObjectModel& model = DefaultObjectModel());

}  // namespace kestrel
