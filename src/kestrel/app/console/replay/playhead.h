// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Position in a recording and speed of play.
class Playhead {
 public:
  // 'times': time of each frame since the first, in order; at least one.
  explicit Playhead(std::vector<Duration> times) : times_(std::move(times)) {}

  std::size_t frame() const { return frame_; }
  double speed() const { return speed_; }

  // 'speed': factor of real time; 0: hold, negative: backwards. At the end, forward play starts
  // anew.
  void Play(double speed);
  void Hold() { speed_ = 0; }
  // Goes to the frame nearest to this time after the first.
  void Seek(double seconds) { GoTo(NearestFrame(seconds)); }
  // Goes forward by this number of frames, at most to the ends, and holds.
  void Step(double frames);
  // Advances by the elapsed time; holds at the ends. Returns true when frame or speed have changed.
  bool Advance(Duration elapsed);

 private:
  void GoTo(std::size_t frame);
  double SecondsOf(std::size_t frame) const { return ToSeconds(times_[frame]); }
  std::size_t NearestFrame(double seconds) const;

  std::vector<Duration> times_;
  std::size_t frame_ = 0;
  double position_s_ = 0;  // time since the first frame
  double speed_ = 0;
};

}  // namespace kestrel
