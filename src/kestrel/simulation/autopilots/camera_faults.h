// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace kestrel {

enum class CameraFault {
  kNone,
  kFrozen,  // the same image again and again, with new stamps
  kBlack,
  kBright,   // nearly all of it saturated
  kSlow,     // three images a second
  kStopped,  // no images
  kBeside,   // all is seen 1.5 m beside where it is, as by a track on a wrong object
};

// What goes wrong with a simulated camera, for a while.
struct CameraFaultOptions {
  std::string kind = "none";  // none, frozen, black, bright, slow, stopped or beside
  double after_s = 10;        // from the camera's start
  double for_s = 2;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("kind", self.kind, "", "none, frozen, black, bright, slow, stopped or beside");
    visitor("after_s", self.after_s, "s", "from the start");
    visitor("for_s", self.for_s, "s", "for so long");
  }
  std::vector<std::string> Validate() const;

  // The fault that there is so long after the start.
  CameraFault At(double since_start_s) const;
};

}  // namespace kestrel
