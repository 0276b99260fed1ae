// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <thread>
#include <vector>

namespace kestrel {

// Calls 'work' with 0 ... count - 1, on 'threads' threads. Passes on what 'work' throws.
template <class Work>
void ForEachIndex(std::size_t count, unsigned threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::future<void>> workers;
  for (unsigned i = 0; i < threads; ++i) {
    workers.push_back(std::async(std::launch::async, [&] {
      for (std::size_t index = next++; index < count; index = next++) work(index);
    }));
  }
  for (std::future<void>& worker : workers) worker.get();
}

// The same, with one thread for each core.
template <class Work>
void ForEachIndex(std::size_t count, const Work& work) {
  ForEachIndex(count, std::max(1U, std::thread::hardware_concurrency()), work);
}

}  // namespace kestrel
