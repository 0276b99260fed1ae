// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Whether one of several cameras contributes to the track, or why not.
enum class CameraHealth {
  kGood,
  kSilent,       // sends no images
  kFrozen,       // repeats its image
  kContradicts,  // sees the target elsewhere than the others; for good
};

struct CameraState {
  CameraHealth health = CameraHealth::kGood;
  Time since;           // time of the frame that showed the fault, or its end
  double offset_m = 0;  // kContradicts: median distance from the place where the others see it
};
// "sees the target 0.52 m from where the others see it: ...".
std::string InWords(const CameraState& state);

}  // namespace kestrel
