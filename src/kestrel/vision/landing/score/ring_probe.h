// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <opencv2/core.hpp>

#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/location/pattern_view.h"

namespace kestrel {

// A cheap test of a ring before its inside is examined.
class RingProbe {
 public:
  explicit RingProbe(const LandingPattern& pattern);

  // Half the side of the square that a view must cover, m.
  double extent_m() const { return extent_m_; }

  // Returns the median contrast, gray values, of the ring and the white around it, for any turn of
  // the pattern. 0 when less than a sixth of the ring is in view or there is no white inside. Does
  // not allocate.
  double Contrast(const cv::Mat& image, const PatternView& view) const;

 private:
  static constexpr std::size_t kPlaces = 48;  // around the ring

  double extent_m_;
  // Places of the plane: first those inside of the ring, then on it, then outside of it.
  std::array<float, 3 * kPlaces> x_m_, y_m_;
};

}  // namespace kestrel
