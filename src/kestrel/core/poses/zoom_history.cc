// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/poses/zoom_history.h"

#include <cmath>

namespace kestrel {
namespace {

bool Agree(const ZoomSample& a, const ZoomSample& b) {
  constexpr double kTolerance = 0.01;
  return std::abs(a.view_rad - b.view_rad) <= kTolerance * a.view_rad;
}

}  // namespace

PoseStatus ZoomHistory::Add(const ZoomSample& sample) {
  if (!(sample.view_rad > 0) || !std::isfinite(sample.view_rad)) return PoseStatus::kInvalid;
  if (size_ > 0 && sample.time <= Sample(size_ - 1).time) return PoseStatus::kOutOfOrder;
  ring_[(first_ + size_) % ring_.size()] = sample;
  if (size_ < ring_.size()) {
    ++size_;
  } else {
    first_ = (first_ + 1) % ring_.size();
  }
  return PoseStatus::kOk;
}

std::optional<double> ZoomHistory::At(Time time) const {
  std::size_t after = size_;  // the first report after 'time'; the newest ones are wanted
  while (after > 0 && Sample(after - 1).time > time) --after;
  if (after == 0) return std::nullopt;
  const ZoomSample& before = Sample(after - 1);
  if (time - before.time > kMaxAge) return std::nullopt;
  if (broken_ && before.time < *broken_ && time >= *broken_) return std::nullopt;
  if (after < size_) {
    if (!Agree(before, Sample(after))) return std::nullopt;
  } else if (after > 1 && !Agree(before, Sample(after - 2)) &&
             before.time - Sample(after - 2).time < kMaxAge) {
    return std::nullopt;
  }
  return before.view_rad;
}

}  // namespace kestrel
