// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <deque>
#include <utility>

#include "kestrel/core/base/time.h"

namespace kestrel {

// A camera of a test flight: takes an image in each period, which is processed 40 ms later. 'Image'
// has the time at which it was 'captured'.
template <class Image>
class LateImages {
 public:
  // Calls 'capture' when an image is due, which returns it, and 'process' with one that has come.
  template <class Capture, class Process>
  void See(Time now, const Capture& capture, const Process& process) {
    constexpr Duration kPeriod = std::chrono::milliseconds(60);
    constexpr Duration kLatency = std::chrono::milliseconds(40);
    if (now >= due_) {
      due_ = now + kPeriod;
      images_.push_back(capture());
    }
    if (images_.empty() || now < images_.front().captured + kLatency) return;
    process(std::as_const(images_.front()));
    images_.pop_front();
  }

 private:
  std::deque<Image> images_;
  Time due_{};
};

}  // namespace kestrel
