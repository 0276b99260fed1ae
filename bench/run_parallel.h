// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace kestrel {

// Calls 'run' with 0 ... count - 1, one at a time on each core.
template <class Run>
void RunParallel(int count, const Run& run) {
  std::atomic<int> next = 0;
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) run(i);
  };
  std::vector<std::thread> threads(std::max(1U, std::thread::hardware_concurrency()) - 1);
  for (std::thread& thread : threads) thread = std::thread(work);
  work();
  for (std::thread& thread : threads) thread.join();
}

}  // namespace kestrel
