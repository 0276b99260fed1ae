// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/gust_feed.h"

#include <cmath>

#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

constexpr double kLostAfter_s = 0.25;  // observations further apart do not continue each other
constexpr double kMostPush = 4;        // m/s^2
constexpr double kBandwidth = 12;      // of the filter, rad/s
constexpr double kAnswer_s = 0.1;      // until the path, whose jerk is limited, has moved
constexpr double kLasting_s = 0.6;     // for which a change of the push goes on

}  // namespace

// A filter of fading memory of second degree (Morrison, Introduction to sequential smoothing and
// prediction, 1969), driven by the lean.
void GustFeed::Observe(Time now, const Vector2d& velocity, const Vector2d& lean) {
  const double seconds = time_ ? ToSeconds(now - *time_) : kLostAfter_s;
  const Vector2d thrust = 0.5 * kGravity * (lean_ + lean);
  lean_ = lean;
  if (!(seconds < kLostAfter_s)) {
    velocity_ = velocity;
    push_.setZero();
    push_change_.setZero();
    is_moving_ = false;
    time_ = now;
    return;
  }
  if (!(seconds > 0)) return;
  time_ = now;
  velocity_ += seconds * (thrust + push_ + 0.5 * seconds * push_change_);
  push_ += seconds * push_change_;
  push_change_ *= std::exp(-seconds / kLasting_s);
  const double kept = std::exp(-kBandwidth * seconds);
  const double lost = 1 - kept;
  const Vector2d error = velocity - velocity_;
  velocity_ += (1 - kept * kept * kept) * error;
  push_ += 1.5 * lost * lost * (1 + kept) / seconds * error;
  push_change_ += lost * lost * lost / (seconds * seconds) * error;
  const double size = push_.norm();
  if (size > kMostPush) push_ *= kMostPush / size;
}

void GustFeed::Forget() {
  time_.reset();
  path_ = {};
}

// It begins where the control's integral carries the push already.
void GustFeed::Move(double ahead_s) {
  if (!time_) return;
  const double lasts_s = kLasting_s * (1 - std::exp(-(ahead_s + kAnswer_s) / kLasting_s));
  const Vector2d lasting = lasts_s * push_change_;
  Vector2d wanted = -(push_ + lasting);
  const double most = wanted.norm();
  if (most > kMostPush) wanted *= kMostPush / most;
  const auto& [place, p, i, d] = control_;
  const double seconds = is_moving_ ? ToSeconds(*time_ - path_.time) : kLostAfter_s;
  if (!(seconds < kLostAfter_s)) {
    path_ = {};
    path_.integral = wanted / (i * place);
    is_moving_ = true;
  } else {
    path_.acceleration = (wanted - (p + d * place) * path_.velocity -
                          (p * place + i) * path_.displacement - i * place * path_.integral) /
                         (1 + d);
    path_.velocity += seconds * path_.acceleration;
    path_.displacement += seconds * path_.velocity;
    path_.integral += seconds * path_.displacement;
  }
  path_.time = *time_;
}

}  // namespace kestrel
