// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>

#include "kestrel/core/base/time.h"

namespace kestrel {

// The sign of life of one thread, which others look at.
class SignOfLife {
 public:
  // The thread works, and gives the next sign before 'limit' has passed.
  void Give(Time now) { given_ = now; }
  // The thread waits for something that may never come: it is alive.
  void Rest() { given_ = Time::max(); }

  // False when the last sign is older than 'limit'.
  bool IsAlive(Time now, Duration limit) const {
    const Time given = given_;
    return given >= now || now - given < limit;
  }

 private:
  std::atomic<Time> given_ = Time::max();
};

}  // namespace kestrel
