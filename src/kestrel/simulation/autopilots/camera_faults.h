// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace kestrel {

enum class CameraFault {
  kNone,
  kFrozen,  // repeats the same image with new stamps
  kBlack,
  kBright,   // nearly all pixels saturated
  kSlow,     // three images per second
  kStopped,  // no images
  kBeside,   // everything appears 1.5 m beside its place, as with a track on a wrong object
};

// A temporary fault of a simulated camera.
struct CameraFaultOptions {
  std::string kind = "none";  // none, frozen, black, bright, slow, stopped or beside
  double after_s = 10;        // from the camera's start
  double for_s = 2;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("kind", self.kind, "",
            "kind of fault: none, frozen, black, bright, slow, stopped or beside");
    visitor("after_s", self.after_s, "s", "time from the start to the fault");
    visitor("for_s", self.for_s, "s", "duration of the fault");
  }
  std::vector<std::string> Validate() const;

  // Returns the fault at a time since the start.
  CameraFault At(double since_start_s) const;
};

}  // namespace kestrel
