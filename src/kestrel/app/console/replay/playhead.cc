// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/playhead.h"

#include <algorithm>

namespace kestrel {
namespace {

constexpr double kMaxSpeed = 100;

}  // namespace

void Playhead::Play(double speed) {
  speed_ = std::clamp(speed, -kMaxSpeed, kMaxSpeed);
  if (speed_ > 0 && frame_ + 1 == times_.size()) GoTo(0);
}

void Playhead::Step(double frames) {
  const auto last = static_cast<double>(times_.size() - 1);
  speed_ = 0;
  GoTo(static_cast<std::size_t>(std::clamp(static_cast<double>(frame_) + frames, 0.0, last)));
}

bool Playhead::Advance(Duration elapsed) {
  if (speed_ == 0) return false;
  const double end_s = SecondsOf(times_.size() - 1);
  position_s_ = std::clamp(position_s_ + speed_ * ToSeconds(elapsed), 0.0, end_s);
  const std::size_t before = frame_;
  frame_ = NearestFrame(position_s_);
  if (position_s_ > 0 && position_s_ < end_s) return frame_ != before;
  speed_ = 0;
  return true;
}

void Playhead::GoTo(std::size_t frame) {
  frame_ = frame;
  position_s_ = SecondsOf(frame);
}

std::size_t Playhead::NearestFrame(double seconds) const {
  const auto is_before = [](Duration time, double time_s) { return ToSeconds(time) < time_s; };
  const auto later = std::lower_bound(times_.begin(), times_.end(), seconds, is_before);
  const auto index = static_cast<std::size_t>(later - times_.begin());
  if (index == 0) return 0;
  if (index == times_.size()) return index - 1;
  return SecondsOf(index) - seconds < seconds - SecondsOf(index - 1) ? index : index - 1;
}

}  // namespace kestrel
