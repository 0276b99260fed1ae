// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// Estimates the period of a camera from the times of its images, of which some are late and some
// missing.
class FramePeriod {
 public:
  // Leaves out times that do not increase.
  void Add(Time captured) {
    if (last_ && captured > *last_) between_[count_++ % kFrames] = captured - *last_;
    last_ = captured;
  }

  // Returns the lower quartile of the latest intervals between images. Dropped images do not
  // lengthen it; a late image, which the next one follows at once, does not shorten it. Nothing
  // until there are enough.
  std::optional<Duration> Get() const {
    if (count_ < kFrames) return std::nullopt;
    std::array<Duration, kFrames> values = between_;
    return RankedInPlace(values, kFrames / 4);
  }

 private:
  static constexpr std::size_t kFrames = 16;

  std::optional<Time> last_;
  std::array<Duration, kFrames> between_;
  std::size_t count_ = 0;
};

}  // namespace kestrel
