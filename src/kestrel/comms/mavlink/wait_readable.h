// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <ctime>
#include <poll.h>
#include <span>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Waits at most 'timeout' for an event on one of the files. Returns the number of files with
// events.
inline int WaitForAny(std::span<pollfd> files, Duration timeout) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::int64_t ns = timeout.count() > 0 ? timeout.count() : 0;
  const timespec time = {static_cast<std::time_t>(ns / kSecond), static_cast<long>(ns % kSecond)};
  return ppoll(files.data(), files.size(), &time, nullptr);
}

// True when there is something to read within 'timeout'.
inline bool WaitReadable(int file, Duration timeout) {
  pollfd entry = {file, POLLIN, 0};
  return WaitForAny({&entry, 1}, timeout) > 0;
}

}  // namespace kestrel
