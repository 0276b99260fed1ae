// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/base/limits.h"

namespace kestrel {

// A process of its own that holds the line to the autopilot while guidance may fly, and stops the
// UAV when the program that flies is gone: docs/guard.md.
struct GuardOptions {
  bool enabled = true;
  double silence_s = 0.2;
  std::string program;

  static void Visit(auto& self, auto&& visit) {
    visit("enabled", self.enabled, "a guard holds the line while guidance may fly");
    visit("silence_s", self.silence_s, Range{0.1, 1},
          "time without a sign of life after which the guard stops the UAV");
    visit("program", self.program,
          "the guard's program; empty: kestrel-guard beside this one, or in PATH");
  }
};

}  // namespace kestrel
