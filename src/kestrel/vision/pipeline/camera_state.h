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
  kContradicts,  // sees the target elsewhere than the others, until it agrees again
  kAlone,        // contradicts, but is used: no other one sees the target
};

struct CameraState {
  CameraHealth health = CameraHealth::kGood;
  Time since;  // time of the frame that showed the fault, or its end
  // kContradicts, kAlone: median distance from the place where the others saw it.
  double offset_m = 0;

  bool is_used() const { return health == CameraHealth::kGood || health == CameraHealth::kAlone; }
};
// "sees the target 0.52 m from where the others see it: ...".
std::string InWords(const CameraState& state);

}  // namespace kestrel
