// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace kestrel {

// Where and how urgently a thread runs.
struct ThreadOptions {
  int cpu = -1;      // the processor that it stays on, from 0; -1: any
  int priority = 0;  // 1 to 99: SCHED_FIFO, before all usual threads; 0: a usual thread

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("cpu", self.cpu, "", "processor that the thread stays on, -1 for any");
    visitor("priority", self.priority, "1", "of SCHED_FIFO, 1 to 99, 0 for a usual thread");
  }
  // Also names a processor that this computer has not.
  std::vector<std::string> Validate() const;
};

// Names the calling thread ('name', up to 15 characters, is what `top -H` shows) and applies the
// options to it. What the system does not permit stays as it was: returns that in words, with what
// to do; empty when all is as wanted.
std::string SetUpThisThread(const std::string& name, const ThreadOptions& options);

}  // namespace kestrel
