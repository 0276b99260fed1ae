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

// Runs one long job in a thread of its own with low priority. Call all functions from one thread.
template <class Result>
class BackgroundRun {
 public:
  // The job reports how many frames are done. A return value of false requests its end.
  using GoOn = std::function<bool(std::size_t done)>;
  // Returns the result, or nothing if its end was requested. Throws InputError.
  using Job = std::function<std::optional<Result>(const GoOn& go_on)>;

  BackgroundRun() = default;
  ~BackgroundRun() { Cancel(); }
  BackgroundRun(const BackgroundRun&) = delete;
  BackgroundRun& operator=(const BackgroundRun&) = delete;

  // Cancels the job before, if any, and starts this one. 'name': name of the thread, at most 15
  // characters.
  void Start(const std::string& name, Job job) {
    Cancel();
    done_ = 0;
    is_cancelled_ = false;
    is_over_ = false;
    outcome_ = {};
    thread_ = std::thread([this, name, job = std::move(job)] { Run(name, job); });
  }

  // Requests the end of the job, without waiting. Its outcome then has neither a result nor an
  // error.
  void RequestEnd() { is_cancelled_ = true; }

  // Ends the job and waits for it: at most from one call of GoOn to the next. Returns false
  // when there was no job.
  bool Cancel() {
    if (!thread_.joinable()) return false;
    RequestEnd();
    thread_.join();
    return true;
  }

  bool is_running() const { return thread_.joinable(); }
  std::size_t done() const { return done_; }

  // Returns the outcome of the job, once; nothing while it runs.
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
    constexpr int kLast = 10;  // the page has priority
    // On Linux this concerns this thread only.
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
  Outcome outcome_;  // belongs to the thread until is_over_
  std::thread thread_;
};

}  // namespace kestrel
