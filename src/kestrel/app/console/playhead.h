// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Where a recording is, and how fast it plays.
class Playhead {
 public:
  // 'times': of each frame since the first, in order; at least one.
  explicit Playhead(std::vector<Duration> times) : times_(std::move(times)) {}

  std::size_t frame() const { return frame_; }
  double speed() const { return speed_; }

  // At so many times the speed, 0: hold, negative: backwards; forward from the end it begins anew.
  void Play(double speed);
  void Hold() { speed_ = 0; }
  // To the frame that is nearest to so many seconds after the first.
  void Seek(double seconds) { GoTo(NearestFrame(seconds)); }
  // So many frames forward, no further than to the ends; holds.
  void Step(double frames);
  // So much time has gone by. At the ends it holds. True: frame or speed are others.
  bool Advance(Duration elapsed);

 private:
  void GoTo(std::size_t frame);
  double SecondsOf(std::size_t frame) const { return ToSeconds(times_[frame]); }
  std::size_t NearestFrame(double seconds) const;

  std::vector<Duration> times_;
  std::size_t frame_ = 0;
  double position_s_ = 0;  // since the first frame
  double speed_ = 0;
};

}  // namespace kestrel
