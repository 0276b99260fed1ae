// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace kestrel {

// A process of its own that holds the line to the autopilot while guidance may fly, and stops the
// UAV when the program that flies is gone: docs/guard.md.
struct GuardOptions {
  bool enabled = true;
  // Without a sign of life for so long the program is taken for dead.
  double silence_s = 0.2;
  // The guard's program; empty: kestrel-guard beside this program, or in PATH.
  std::string program;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("enabled", self.enabled, "", "a guard holds the line while guidance may fly");
    visitor("silence_s", self.silence_s, "s",
            "time without a sign of life after which the guard stops the UAV");
    visitor("program", self.program, "",
            "the guard's program; empty: kestrel-guard beside this one, or in PATH");
  }
  std::vector<std::string> Validate() const;
};

}  // namespace kestrel
