// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>

namespace kestrel {

// Hands the newest value from one thread to another; neither ever waits. There are three slots: the
// writer has one, the reader one, and the third is exchanged between them.
template <class T>
class LatestValue {
 public:
  // Called by the writing thread only.
  void Set(const T& value) {
    slots_[writing_] = value;
    writing_ = between_.exchange(writing_ | kIsNew, std::memory_order_acq_rel) & kSlot;
  }

  // Called by the reading thread only. Returns the newest value, a default one before the first.
  // Valid until the next call.
  const T& Get() {
    if (between_.load(std::memory_order_relaxed) & kIsNew) {
      reading_ = between_.exchange(reading_, std::memory_order_acq_rel) & kSlot;
    }
    return slots_[reading_];
  }

 private:
  static constexpr unsigned kSlot = 3, kIsNew = 4;

  std::array<T, 3> slots_{};
  unsigned writing_ = 0;
  unsigned reading_ = 1;
  std::atomic<unsigned> between_{2};
};

}  // namespace kestrel
