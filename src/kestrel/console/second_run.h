// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "kestrel/console/landing_view.h"
#include "kestrel/console/replay_frame.h"

namespace kestrel {

// A run over a recording in a thread of its own. All functions by one thread.
class SecondRun {
 public:
  // Is told how many frames are done; false: it is to end.
  using GoOn = std::function<bool(std::size_t done)>;
  // Gives what was found, or nothing when it was to end; throws InputError.
  using Job = std::function<std::optional<ReplayResult>(const GoOn& go_on)>;

  SecondRun() = default;
  ~SecondRun() { Cancel(); }
  SecondRun(const SecondRun&) = delete;
  SecondRun& operator=(const SecondRun&) = delete;

  // Ends the one before.
  void Start(Job job);
  // Waits for no longer than a frame takes. False: there was none.
  bool Cancel();

  bool is_running() const { return thread_.joinable(); }
  std::size_t done() const { return done_; }

  // What it came to, once; nothing as long as it runs.
  struct Outcome {
    std::optional<ReplayResult> result;
    std::string error;  // why there is no result
  };
  std::optional<Outcome> TakeOutcome();

 private:
  void Run(const Job& job);

  std::atomic<std::size_t> done_{0};
  std::atomic<bool> is_cancelled_{false}, is_over_{false};
  Outcome outcome_;  // the thread's until it is over
  std::thread thread_;
};

}  // namespace kestrel
