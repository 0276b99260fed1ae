// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace kestrel {

// Processor and priority of a thread.
struct ThreadOptions {
  int cpu = -1;      // processor to which the thread is pinned, from 0; -1: any
  int priority = 0;  // 1 to 99: SCHED_FIFO, before all normal threads; 0: a normal thread

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("cpu", self.cpu, "", "processor on which the thread stays; -1: any");
    visitor("priority", self.priority, "1", "priority of SCHED_FIFO, 1 to 99; 0: a normal thread");
  }
  // Also reports a processor that this computer does not have.
  std::vector<std::string> Validate() const;
};

// Names the calling thread ('name', up to 15 characters, is shown by `top -H`) and applies the
// options to it. Settings that the system does not permit stay unchanged: the result describes them
// and what to do; it is empty on full success.
std::string SetUpThisThread(const std::string& name, const ThreadOptions& options);

}  // namespace kestrel
