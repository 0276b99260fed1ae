// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <sys/resource.h>
#include <thread>
#include <utility>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/thread_setup.h"

namespace kestrel {

// What takes long, in a thread of its own and after all others. All functions by one thread.
template <class Result>
class BackgroundRun {
 public:
  // Is told how many frames are done; false: the job is to end.
  using GoOn = std::function<bool(std::size_t done)>;
  // Gives what was found, or nothing when it was to end; throws InputError.
  using Job = std::function<std::optional<Result>(const GoOn& go_on)>;

  BackgroundRun() = default;
  ~BackgroundRun() { Cancel(); }
  BackgroundRun(const BackgroundRun&) = delete;
  BackgroundRun& operator=(const BackgroundRun&) = delete;

  // Ends the one before. 'name': of the thread, up to 15 characters.
  void Start(const std::string& name, Job job) {
    Cancel();
    done_ = 0;
    is_cancelled_ = false;
    is_over_ = false;
    outcome_ = {};
    thread_ = std::thread([this, name, job = std::move(job)] { Run(name, job); });
  }

  // Tells the job to end; its outcome then has neither a result nor an error.
  void RequestEnd() { is_cancelled_ = true; }

  // The same, and waits until it has: no longer than from one GoOn to the next. False: there was
  // none.
  bool Cancel() {
    if (!thread_.joinable()) return false;
    RequestEnd();
    thread_.join();
    return true;
  }

  bool is_running() const { return thread_.joinable(); }
  std::size_t done() const { return done_; }

  // What it came to, once; nothing as long as it runs.
  struct Outcome {
    std::optional<Result> result;
    std::string error;  // why there is no result
  };
  std::optional<Outcome> TakeOutcome() {
    if (!thread_.joinable() || !is_over_) return std::nullopt;
    thread_.join();
    return std::exchange(outcome_, {});
  }

 private:
  void Run(const std::string& name, const Job& job) {
    SetUpThisThread(name, {});
    constexpr int kLast = 10;  // the page goes first
    // Of this thread alone, on Linux.
    setpriority(PRIO_PROCESS, 0, kLast);
    try {
      outcome_.result = job([this](std::size_t done) {
        done_ = done;
        return !is_cancelled_;
      });
    } catch (const InputError& error) {
      outcome_.error = error.what();
    }
    is_over_ = true;
  }

  std::atomic<std::size_t> done_{0};
  std::atomic<bool> is_cancelled_{false}, is_over_{false};
  Outcome outcome_;  // the thread's until it is over
  std::thread thread_;
};

}  // namespace kestrel
