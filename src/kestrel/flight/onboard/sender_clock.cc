// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/sender_clock.h"

#include <algorithm>
#include <chrono>

namespace kestrel {
namespace {

// Quartz clocks differ by 100 ppm at most; the rest makes up for an offset that came out too low.
constexpr int kDriftPerMillion = 200;
// No frame comes so much earlier than the fastest one before.
constexpr Duration kStep = std::chrono::milliseconds(100);
constexpr int kNewStamps = 3;  // odd frames in a row that follow each other

}  // namespace

bool SenderClock::IsOdd(Time stamp, Time arrival) const {
  if (stamp <= stamp_) return true;
  return is_settled() && arrival - (stamp + offset_) < -kStep;
}

Time SenderClock::Begin(Time stamp, Time arrival) {
  frames_ = 1;
  odd_ = 0;
  stamp_ = stamp;
  arrival_ = arrival;
  offset_ = arrival - stamp;
  typical_ = Duration::zero();
  return arrival;
}

Time SenderClock::Map(Time stamp, Time arrival) {
  if (frames_ == 0) return Begin(stamp, arrival);
  if (IsOdd(stamp, arrival)) {
    const bool follows = odd_ > 0 && stamp > odd_stamp_;
    odd_ = follows ? odd_ + 1 : 1;
    odd_stamp_ = stamp;
    return odd_ < kNewStamps ? arrival - typical_ : Begin(stamp, arrival);
  }
  odd_ = 0;
  const Duration drift =
      std::max(arrival - arrival_, Duration::zero()) / 1'000'000 * kDriftPerMillion;
  offset_ = std::min(arrival - stamp, offset_ + drift);
  stamp_ = stamp;
  arrival_ = arrival;
  ++frames_;
  typical_ += (arrival - (stamp + offset_) - typical_) / std::min(frames_, kSettled);
  return stamp + offset_;
}

}  // namespace kestrel
