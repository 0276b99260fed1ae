// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "kestrel/base/time.h"

namespace kestrel {

// The period of a camera by the times of its images, some of which may have been dropped.
class FramePeriod {
 public:
  // Times that do not grow are left out.
  void Add(Time captured) {
    if (last_ && captured > *last_) between_[count_++ % kFrames] = captured - *last_;
    last_ = captured;
  }

  // The shortest of the last times between two images; nothing before there are enough.
  std::optional<Duration> Get() const {
    if (count_ < kFrames) return std::nullopt;
    return *std::min_element(between_.begin(), between_.end());
  }

 private:
  static constexpr std::size_t kFrames = 16;

  std::optional<Time> last_;
  std::array<Duration, kFrames> between_;
  std::size_t count_ = 0;
};

}  // namespace kestrel
