// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>

#include "kestrel/app/web_server/live_page.h"

namespace kestrel {

// The queue of messages for one client. When it is full the oldest is dropped. Used by one thread.
class TelemetryChannel {
 public:
  // 'capacity': at least 1.
  explicit TelemetryChannel(std::size_t capacity) : capacity_(capacity) {}

  void Push(SharedMessage message) {
    if (waiting_.size() == capacity_) {
      waiting_.pop_front();
      ++dropped_;
    }
    waiting_.push_back(std::move(message));
  }

  // Returns the oldest message; null when there is none.
  SharedMessage Pop() {
    if (waiting_.empty()) return nullptr;
    SharedMessage message = std::move(waiting_.front());
    waiting_.pop_front();
    return message;
  }

  // Number of dropped messages.
  std::uint64_t dropped() const { return dropped_; }

 private:
  std::size_t capacity_;
  std::deque<SharedMessage> waiting_;
  std::uint64_t dropped_ = 0;
};

}  // namespace kestrel
