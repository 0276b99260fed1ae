// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "kestrel/core/base/time.h"

namespace kestrel {

// A bounded queue between threads whose Push never blocks: when it is full, the oldest value is
// dropped. With a capacity of 1 it holds the newest value. Values are moved in and out under the
// lock and destroyed outside of it. Allocates at construction only, as far as moving a T does not
// allocate. All functions are thread-safe.
template <class T>
class BoundedQueue {
 public:
  // 'capacity': at least 1.
  explicit BoundedQueue(std::size_t capacity) : ring_(std::max<std::size_t>(capacity, 1)) {}

  // Appends a value, unless the queue is closed. Returns the value that was dropped to make room,
  // or 'value' itself when the queue is closed.
  std::optional<T> Push(T value) {
    std::optional<T> dropped;
    {
      const std::lock_guard lock(mutex_);
      if (is_closed_) return value;
      if (size_ == ring_.size()) {
        dropped = TakeFirst();
        ++dropped_;
      }
      ring_[(first_ + size_++) % ring_.size()] = std::move(value);
    }
    changed_.notify_one();
    return dropped;
  }

  // Removes and returns the oldest value, if there is one.
  std::optional<T> TryPop() {
    const std::lock_guard lock(mutex_);
    return TakeFirst();
  }

  // The same, but waits for a value up to 'timeout', or until Close.
  std::optional<T> Pop(Duration timeout) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return size_ > 0 || is_closed_; });
    return TakeFirst();
  }

  // Closes the queue: no more values are accepted, those inside can still be taken, and waiting
  // ends.
  void Close() {
    {
      const std::lock_guard lock(mutex_);
      is_closed_ = true;
    }
    changed_.notify_all();
  }

  std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return size_;
  }
  // Number of values that were dropped.
  std::size_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  std::optional<T> TakeFirst() {
    if (size_ == 0) return std::nullopt;
    std::optional<T> value(std::move(ring_[first_]));
    first_ = (first_ + 1) % ring_.size();
    --size_;
    return value;
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<T> ring_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::size_t dropped_ = 0;
  bool is_closed_ = false;
};

}  // namespace kestrel
