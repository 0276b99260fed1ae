// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/pad_motion_watch.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace kestrel {
namespace {

using Eigen::Vector2d;

constexpr Duration kSpan = std::chrono::seconds(1);
constexpr Duration kKept = 2 * kSpan + std::chrono::milliseconds(300);
constexpr Duration kGap = std::chrono::milliseconds(150);  // longest between two samples
constexpr double kLimit_m = 0.5;  // a pad whose speed has changed by 0.5 m/s at once
constexpr int kSurePlaces = 5;    // places in a row
constexpr double kMean_s = 15;    // time constant of what stays
constexpr double kLearn_s = 2;    // until it is known

template <class Samples>
void Forget(Time oldest, Samples* samples) {
  const auto kept =
      std::ranges::find_if(*samples, [&](const auto& sample) { return sample.time >= oldest; });
  samples->erase(samples->begin(), kept);
}

}  // namespace

PadMotionWatch::PadMotionWatch() {
  constexpr std::size_t kMost = 1024;  // enough for fast streams
  accelerations_.reserve(kMost);
  places_.reserve(kMost);
}

void PadMotionWatch::AddAcceleration(Time time, const Eigen::Vector3d& acceleration) {
  if (!acceleration.allFinite()) return;
  if (!accelerations_.empty() && time <= accelerations_.back().time) return;
  accelerations_.push_back({time, acceleration.head<2>()});
  Forget(time - kKept, &accelerations_);
}

bool PadMotionWatch::Update(Time time, const Eigen::Vector3d& place) {
  if (!places_.empty() && time - places_.back().time > kGap) places_.clear();
  places_.push_back({time, place.head<2>()});
  Forget(time - kKept, &places_);
  const auto middle = PlaceAt(time - kSpan), first = PlaceAt(time - 2 * kSpan);
  const auto measured = MeasuredChange(time - kSpan);
  if (!middle || !first || !measured) return false;
  const Vector2d mismatch = place.head<2>() - 2 * *middle + *first - *measured;
  const double since_s = learnt_ ? std::min(ToSeconds(time - *learnt_), ToSeconds(kGap)) : 0;
  learnt_ = time;
  const bool contradicts = learnt_s_ > kLearn_s && (mismatch - usual_).norm() > kLimit_m;
  contradictions_ = contradicts ? contradictions_ + 1 : 0;
  if (contradicts) return contradictions_ >= kSurePlaces;
  learnt_s_ += since_s;
  usual_ += since_s / std::clamp(learnt_s_, ToSeconds(kGap), kMean_s) * (mismatch - usual_);
  return false;
}

void PadMotionWatch::Reset() {
  places_.clear();
  contradictions_ = 0;
}

std::optional<Vector2d> PadMotionWatch::PlaceAt(Time time) const {
  const auto after = std::ranges::lower_bound(places_, time, {}, &Sample::time);
  if (after == places_.end() || after == places_.begin()) return std::nullopt;
  const auto before = after - 1;
  const double share = ToSeconds(time - before->time) / ToSeconds(after->time - before->time);
  return (1 - share) * before->value + share * after->value;
}

// Returns the difference of the two changes of place that the accelerations cause: their integral
// under a triangle with its top in the middle.
std::optional<Vector2d> PadMotionWatch::MeasuredChange(Time middle) const {
  const Time begin = middle - kSpan, end = middle + kSpan;
  if (accelerations_.empty() || accelerations_.front().time > begin + kGap ||
      accelerations_.back().time < end - kGap) {
    return std::nullopt;
  }
  Vector2d sum = Vector2d::Zero();
  Time last = begin;
  for (const Sample& sample : accelerations_) {
    const Time time = std::clamp(sample.time, begin, end);
    if (time - last > kGap) return std::nullopt;
    const double height_s = ToSeconds(kSpan) - std::abs(ToSeconds(time - middle));
    sum += height_s * ToSeconds(time - last) * sample.value;
    last = time;
  }
  return sum;
}

}  // namespace kestrel
