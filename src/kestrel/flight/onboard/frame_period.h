// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "kestrel/core/base/time.h"

namespace kestrel {

// The period of a camera by the times of its images, of which some come late and some not at all.
class FramePeriod {
 public:
  // Times that do not grow are left out.
  void Add(Time captured) {
    if (last_ && captured > *last_) between_[count_++ % kFrames] = captured - *last_;
    last_ = captured;
  }

  // The lower quartile of the last times between two images: images that were dropped do not
  // lengthen it, nor does a late one, which the next follows at once, shorten it. Nothing before
  // there are enough.
  std::optional<Duration> Get() const {
    if (count_ < kFrames) return std::nullopt;
    std::array<Duration, kFrames> sorted = between_;
    const auto quartile = sorted.begin() + kFrames / 4;
    std::nth_element(sorted.begin(), quartile, sorted.end());
    return *quartile;
  }

 private:
  static constexpr std::size_t kFrames = 16;

  std::optional<Time> last_;
  std::array<Duration, kFrames> between_;
  std::size_t count_ = 0;
};

}  // namespace kestrel
