// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/core/base/limits.h"

namespace kestrel {

// Processor and priority of a thread.
struct ThreadOptions {
  int cpu = -1;
  int priority = 0;

  static void Visit(auto& self, auto&& visit) {
    visit("cpu", self.cpu, AtLeast(-1), "processor on which the thread stays; -1: any");
    visit("priority", self.priority, Range{0, 99},
          "priority of SCHED_FIFO, before all normal threads; 0: a normal thread");
  }
  // Reports a processor that this computer does not have.
  std::vector<std::string> Validate() const;
};

// Names the calling thread ('name', up to 15 characters, is shown by `top -H`) and applies the
// options to it. Settings that the system does not permit stay unchanged: the result describes them
// and what to do; it is empty on full success.
std::string SetUpThisThread(const std::string& name, const ThreadOptions& options);

}  // namespace kestrel
