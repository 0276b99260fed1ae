// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Summary of a step. Times in s; 0 where there was none.
struct LatencySummary {
  std::uint64_t count = 0;
  std::uint64_t dropped = 0;  // began the step, but never ended it
  double median_s = 0;        // within 1 %, like p99
  double p99_s = 0;
  double max_s = 0;
};

// Durations of a step: a histogram of fixed size over the logarithm of the time, from 1 us to 1000
// s. One thread adds, any thread may read; neither locks nor allocates.
class LatencyHistogram {
 public:
  // Times outside of the histogram count in its first or last bin; a negative one (the clock
  // stepped back) counts in the first.
  void Add(Duration latency);
  void AddDropped(std::uint64_t count = 1) { dropped_.fetch_add(count, kOrder); }

  LatencySummary Summary() const;

 private:
  static constexpr auto kOrder = std::memory_order_relaxed;
  static constexpr std::size_t kBins = 1042;  // each 2 % wide

  std::array<std::atomic<std::uint64_t>, kBins> bins_{};
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<std::int64_t> max_ns_{0};
};

// Latencies of all steps of a program.
class LatencyStatistics {
 public:
  // 'steps': names of the steps, as "capture to detection".
  explicit LatencyStatistics(std::vector<std::string> steps);

  LatencyHistogram& step(std::size_t index) { return histograms_[index]; }
  const LatencyHistogram& step(std::size_t index) const { return histograms_[index]; }

  // Returns a line for each step: "capture to detection: median 4.21 ms, p99 7.92, max 12.40; 3 of
  // 1000 dropped". Steps in which nothing happened are left out.
  std::string InWords() const;

 private:
  std::vector<std::string> names_;
  std::vector<LatencyHistogram> histograms_;
};

}  // namespace kestrel
