// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/road_memory.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace kestrel {
namespace {

using Eigen::Vector2d;

constexpr double kSampleStep_s = 0.2;  // between samples: 200 s in all
// The same place on the road: no further apart, the velocity no more different, and so long ago.
constexpr double kSamePlace_m = 2.5;
constexpr double kSameVelocity = 0.3;  // share of the speed
constexpr double kLeastLap_s = 6;
constexpr double kLeastSpeed_mps = 0.5;  // a target that stands has no lap
constexpr double kCurve_s = 2;           // a curve goes on for so long, without a lap
// Growth of the standard deviation: by an acceleration that is not known, and on a lap by a speed
// that differs from the one before.
constexpr double kUnknownAcceleration = 0.6;  // m/s^2
constexpr double kLapSpeedSigma = 0.1;        // share of the speed
constexpr double kBaseSigma_m = 0.5;

}  // namespace

void RoadMemory::Add(Time time, const Vector2d& position, const Vector2d& velocity,
                     double turn_rate) {
  if (count_ > 0 && ToSeconds(time - At(count_ - 1).time) < kSampleStep_s) return;
  samples_[count_ % kSamples] = {time, position, velocity};
  ++count_;
  turn_rate_ = turn_rate;
  FindLap();
}

// Looks for the newest place a lap ago that is nearest to the present one.
void RoadMemory::FindLap() {
  lap_s_.reset();
  const Sample& now = At(count_ - 1);
  const double speed = now.velocity.norm();
  if (speed < kLeastSpeed_mps) return;
  double nearest_m = kSamePlace_m;
  for (std::int64_t i = count_ - 2; i >= oldest(); --i) {
    const Sample& then = At(i);
    const double ago_s = ToSeconds(now.time - then.time);
    if (ago_s < kLeastLap_s) continue;
    const bool is_same_way = (then.velocity - now.velocity).norm() < kSameVelocity * speed;
    const double distance_m = (then.position - now.position).norm();
    if (is_same_way && distance_m < nearest_m) {
      nearest_m = distance_m;
      lap_s_ = ago_s;
      lap_begin_ = i;
    } else if (lap_s_ && distance_m > 2 * kSamePlace_m) {
      return;  // the lap before that one
    }
  }
}

std::optional<RoadMemory::Prediction> RoadMemory::Predict(Time time) const {
  if (count_ == 0) return std::nullopt;
  const double ahead_s = std::max(ToSeconds(time - At(count_ - 1).time), 0.0);
  if (lap_s_) {
    if (auto by_lap = PredictByLap(ahead_s)) return by_lap;
  }
  return PredictByCurve(ahead_s);
}

// The road from a lap ago until now, driven again and again.
std::optional<RoadMemory::Prediction> RoadMemory::PredictByLap(double ahead_s) const {
  if (lap_begin_ < oldest()) return std::nullopt;
  const Time then = At(lap_begin_).time + DurationFromSeconds(std::fmod(ahead_s, *lap_s_));
  std::int64_t index = lap_begin_;
  while (index + 1 < count_ && At(index + 1).time <= then) ++index;
  const Sample& sample = At(index);
  const Vector2d position = sample.position + ToSeconds(then - sample.time) * sample.velocity;
  const double sigma_m = kBaseSigma_m + kLapSpeedSigma * sample.velocity.norm() * ahead_s;
  return Prediction{position, sample.velocity, sigma_m, true};
}

RoadMemory::Prediction RoadMemory::PredictByCurve(double ahead_s) const {
  const Sample& last = At(count_ - 1);
  const double curve_s = std::min(ahead_s, kCurve_s);
  Vector2d way = curve_s * last.velocity;
  Vector2d velocity = last.velocity;
  if (const double angle = turn_rate_ * curve_s; std::abs(angle) > 1e-3) {
    velocity = Eigen::Rotation2Dd(angle) * last.velocity;
    const Vector2d turned = velocity - last.velocity;
    way = Vector2d(turned.y(), -turned.x()) / turn_rate_;
  }
  const double sigma_m = kBaseSigma_m + 0.5 * kUnknownAcceleration * ahead_s * ahead_s;
  return {last.position + way + (ahead_s - curve_s) * velocity, velocity, sigma_m, false};
}

}  // namespace kestrel
