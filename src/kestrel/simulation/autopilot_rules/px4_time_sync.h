// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

namespace kestrel {

// PX4's estimate of a companion's clock, from the answers to its TIMESYNC requests. It converts the
// companion's stamps only after 500 answers with a round trip below 10 ms; before, a stamp counts
// as the time of its arrival.
class Px4TimeSync {
 public:
  // Takes the answer to the request of 'sent_us', which arrived at 'now_us' (own clock).
  // 'remote_us': the time of the other side's clock in between.
  void AddAnswer(std::int64_t sent_us, std::int64_t remote_us, std::int64_t now_us) {
    constexpr std::int64_t kMaxRoundTrip_us = 10'000;
    if (now_us - sent_us < 0 || now_us - sent_us > kMaxRoundTrip_us) return;
    const std::int64_t offset_us = (sent_us + now_us) / 2 - remote_us;
    constexpr double kFirstGain = 0.05;
    constexpr double kLastGain = 0.003;
    const double gain = is_converged() ? kLastGain : kFirstGain;
    offset_us_ = answers_ == 0 ? static_cast<double>(offset_us)
                               : offset_us_ + gain * (static_cast<double>(offset_us) - offset_us_);
    ++answers_;
  }

  bool is_converged() const { return answers_ >= kAnswersToConverge; }

  // Returns a stamp of the companion on the own clock.
  std::int64_t OwnTime(std::uint64_t stamp_us, std::int64_t now_us) const {
    if (!is_converged()) return now_us;
    // A stamp may be any number: unsigned arithmetic makes an overflow harmless.
    return static_cast<std::int64_t>(stamp_us +
                                     static_cast<std::uint64_t>(std::llround(offset_us_)));
  }

 private:
  static constexpr int kAnswersToConverge = 500;

  int answers_ = 0;
  double offset_us_ = 0;  // own clock minus the companion's
};

}  // namespace kestrel
