// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/base/limits.h"

namespace kestrel {

enum class CameraFault {
  kNone,
  kFrozen,  // repeats the same image with new stamps
  kBlack,
  kBright,   // nearly all pixels saturated
  kSlow,     // three images per second
  kStopped,  // no images
  kBeside,   // everything appears 1.5 m beside its place, as with a track on a wrong object
  kLate,     // images stamped 0.3 s late
  kTurned,   // its mount is turned by 5 degrees
};

// A temporary fault of a simulated camera.
struct CameraFaultOptions {
  std::string kind = "none";
  double after_s = 10;
  double for_s = 2;

  static void Visit(auto& self, auto&& visit) {
    visit(
        "kind", self.kind,
        OneOf{{"none", "frozen", "black", "bright", "slow", "stopped", "beside", "late", "turned"}},
        "kind of fault");
    visit("after_s", self.after_s, Range{0, 10000}, "time from the start to the fault");
    visit("for_s", self.for_s, Range{0, 10000}, "duration of the fault");
  }

  // Returns the fault at a time since the start.
  CameraFault At(double since_start_s) const;
};

}  // namespace kestrel
