// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/verification/pattern_view.h"

namespace kestrel {

// Shares, 0 to 1, of the places that look as in the print, by quarter: quarter k is the right angle
// around arm k. Negative where too little of it is in view.
struct PartShares {
  std::array<double, 4> arm{};
  std::array<double, 4> quadrant{};  // the white between the arms
  std::array<double, 4> ring{};

  struct Means {
    double worst_arm;  // 0 when no arm is in view
    double arms;       // mean over the arms; 0 when none is in view
    double quadrants;
    double ring;  // mean without the worst quarter, which a highlight or the image border may hide
  };
  // Means over the parts in view; quadrants and ring are 1 when none of them is in view.
  Means MeansInView() const;
};

// Agreement of an image with the print under a pose: the shares of local contrasts that the image
// and the print have in common. A part with less than a fifth of its contrasts in view counts as
// not in view.
struct PatternMatch {
  // Arms: darker than the white on both sides. An arm also counts as not in view where something
  // dark hides it together with the white beside it, or when half of it or more lies in a
  // highlight. White: brighter than ring and arms. Ring: darker than the white around it.
  PartShares shares;
  double contrast = 0;  // median contrast of ring and white, gray values
  double seen = 0;      // share of all contrasts that are in view

  // The least of the means of arms, quadrants and ring.
  double Agreement() const;
};

// Compares an image with the print at fixed places, by differences of gray values between
// neighbouring places of white and black. Light that varies over the print, a shadow or a highlight
// therefore spoils only the few differences that its edge crosses.
class PatternMatcher {
 public:
  explicit PatternMatcher(const LandingPattern& pattern);

  // Half the side of the square that a view must cover, m.
  double extent_m() const { return extent_m_; }

  // Returns the median contrast, gray values, of the ring and the white around it, for any turn of
  // the pattern. A cheap test to run first. 0 when less than a sixth of the ring is in view or
  // there is no white inside. Does not allocate.
  double RingContrast(const cv::Mat& image, const PatternView& view) const;

  // Compares the whole print. 'view': of the pattern's frame, x along an arm. Does not allocate.
  PatternMatch Match(const cv::Mat& image, const PatternView& view) const;

 private:
  // Indices of places that should be dark and of places that should be white; two of a kind may be
  // equal.
  struct Contrast {
    int quarter;
    std::array<std::size_t, 2> dark;    // the darker counts
    std::array<std::size_t, 2> bright;  // the darker counts
  };
  struct Seen;
  struct Tally;
  template <std::size_t kMost>
  struct Values;
  class Comparison;

  void AddRing(const LandingPattern& pattern, double outside_m);
  void AddArm(const LandingPattern& pattern, int quarter);
  void AddQuadrant(const LandingPattern& pattern, int quarter);
  // Each returns the index of the new place.
  std::size_t AddPlace(double x_m, double y_m);
  std::size_t AddPolar(double radius_m, double angle);
  std::size_t AddBeside(int quarter, double along_m, double across_m);

  double extent_m_ = 0;
  // Places of the plane, sampled all at once: first those inside of the ring, on it and outside of
  // it, then those of the cross.
  std::vector<float> x_m_;
  std::vector<float> y_m_;
  std::vector<Contrast> ring_;
  std::vector<Contrast> arms_;
  std::vector<Contrast> quadrants_;
};

}  // namespace kestrel
