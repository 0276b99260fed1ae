// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace kestrel {

// Times of one step, one per image, ms.
struct StepTimes {
  std::string step;
  std::vector<double> ms;
  bool is_work = true;  // processor time of one thread; else time that passed
};

// Measures the steps of a flight on images of simulated flights. 'print' receives what is being
// done now. Returns, in this order: the ring in whole images, the ring near its last place, a tag
// in whole images, coloured objects in whole images, the rays of all pixels, and the time from the
// capture of an image to its result in a session that gets 30 images/s.
std::vector<StepTimes> MeasureSteps(const std::function<void(const std::string&)>& print);

}  // namespace kestrel
