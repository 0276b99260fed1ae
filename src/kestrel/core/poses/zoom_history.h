// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"

namespace kestrel {

// The horizontal field of view (rad) that a camera reports, at an instant of its clock.
struct ZoomSample {
  Time time;
  double view_rad = 0;
};

// The latest reports of a zoom, in order of time. Bounded: the newest replaces the oldest.
// Allocates at construction only and never throws afterwards.
class ZoomHistory {
 public:
  // Longest time for which a report holds.
  static constexpr Duration kMaxAge = std::chrono::seconds(3);

  // Keeps up to 'capacity' samples, at least 2.
  explicit ZoomHistory(std::size_t capacity) : ring_(std::max<std::size_t>(capacity, 2)) {}

  // A rejected sample leaves the history unchanged.
  PoseStatus Add(const ZoomSample& sample);

  // The lens has changed at this time: no earlier report holds after it.
  void Break(Time time) { broken_ = time; }

  // Returns the field of view of a lens that is at rest at 'time': the report before it, where
  // those on both sides of it agree to 1 %, after the newest one the newest two. Nothing while the
  // lens moves, before the oldest report, and where the report is older than kMaxAge.
  std::optional<double> At(Time time) const;

 private:
  const ZoomSample& Sample(std::size_t i) const { return ring_[(first_ + i) % ring_.size()]; }

  std::vector<ZoomSample> ring_;
  std::size_t first_ = 0;  // index of the oldest sample in the ring
  std::size_t size_ = 0;
  std::optional<Time> broken_;
};

}  // namespace kestrel
