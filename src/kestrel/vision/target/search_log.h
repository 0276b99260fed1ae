// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>

#include "kestrel/vision/target/target_detection.h"

namespace kestrel {

// Records the progress of the candidates of one image and the time that each stage takes.
class SearchLog {
 public:
  explicit SearchLog(TargetReport* report) : report_(*report) {}

  // Counts a candidate that enters a stage. 'reason_if_it_ends_here' becomes the report's reason
  // unless a candidate comes farther.
  void Reach(LandingStage stage, std::string_view reason_if_it_ends_here) {
    ++report_.diagnostics.candidates[static_cast<int>(stage)];
    if (stage < report_.reached) return;
    report_.reached = stage;
    report_.reason = reason_if_it_ends_here;
  }

  // Adds its lifetime to the time of a stage.
  class Timer {
   public:
    explicit Timer(std::int64_t* total_ns)
        : total_ns_(*total_ns), start_(std::chrono::steady_clock::now()) {}
    ~Timer() { total_ns_ += (std::chrono::steady_clock::now() - start_).count(); }
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

   private:
    std::int64_t& total_ns_;
    std::chrono::steady_clock::time_point start_;
  };
  [[nodiscard]] Timer Time(LandingStage stage) {
    return Timer(&report_.diagnostics.stage_ns[static_cast<int>(stage)]);
  }

 private:
  TargetReport& report_;
};

}  // namespace kestrel
