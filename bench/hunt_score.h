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
  std::string found_as;  // class; empty: no detection within 20 px
  double center_error_px = 0;
};

struct RealFrameScore {
  std::vector<RealDisc> discs;
  int single = 0;  // detections, without those that may be several discs
  int merged = 0;
};

// 'folder': hunt_real, a screenshot without calibration; its plot and legend are painted over.
RealFrameScore ScoreRealFrame(const std::string& folder);

// Digits read right, for the detections of cuboids wholly in view; a 6 upside down is a 9.
struct DigitScore {
  int right = 0;
  int count = 0;
};

struct HuntScore {
  std::vector<ObjectComparison> comparisons;
  // Errors of the detected objects (px): of those that must be found by shape ("disc, wanted") and
  // together ("all, wanted"), and of those that are "cut off, hidden or small".
  std::map<std::string, std::vector<double>> center_errors_px;
  DigitScore digits;
  DigitScore near_digits;  // for cuboids at most 3 m away
};

// Runs HuntPipeline over a recording and compares the result with the truth. Clock offset and mount
// are those of scene.yaml, as from a calibration; the rolling shutter's readout is 25 ms.
HuntScore ScoreHunt(const std::string& folder, const ObjectModel& model = DefaultObjectModel());

}  // namespace kestrel
