// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/console/second_run.h"

#include <sys/resource.h>
#include <utility>

#include "kestrel/base/error.h"
#include "kestrel/onboard/thread_setup.h"

namespace kestrel {

void SecondRun::Start(Job job) {
  Cancel();
  done_ = 0;
  is_cancelled_ = false;
  is_over_ = false;
  outcome_ = {};
  thread_ = std::thread([this, job = std::move(job)] { Run(job); });
}

bool SecondRun::Cancel() {
  if (!thread_.joinable()) return false;
  is_cancelled_ = true;
  thread_.join();
  return true;
}

std::optional<SecondRun::Outcome> SecondRun::TakeOutcome() {
  if (!thread_.joinable() || !is_over_) return std::nullopt;
  thread_.join();
  return std::exchange(outcome_, {});
}

void SecondRun::Run(const Job& job) {
  SetUpThisThread("second run", {});
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

}  // namespace kestrel
