// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/vision/helipad/helipad.h"
#include "kestrel/vision/search/ink_samples.h"
#include "kestrel/vision/search/pad_alignment.h"
#include "kestrel/vision/search/plane_figure.h"

namespace kestrel {

// All that a detector reads of a helipad, computed once.
struct HelipadModel {
  // 'helipad' must be valid.
  explicit HelipadModel(const Helipad& helipad);

  std::vector<PadPart> parts;  // the H, and the frame where there is one
  double radius_m = 0;         // circle around the H
  InkSamples samples;
  double sample_area = 0;        // on the H, for each of its samples, squares of a stroke
  FigureMoments letter_moments;  // the H alone
  FigureMoments frame_moments;   // all within the frame's outer edge; no area without one
};

}  // namespace kestrel
