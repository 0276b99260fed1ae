// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/pattern_view.h"

namespace kestrel {

// Shares, 0 to 1, of what is in its place, quarter by quarter of the print: quarter k is the right
// angle around arm k. Negative where the image shows too little of it.
struct PartShares {
  std::array<double, 4> arm{};
  std::array<double, 4> quadrant{};  // the white between the arms
  std::array<double, 4> ring{};

  struct Means {
    double worst_arm;  // 0 when no arm can be seen
    double arms;       // the same
    double quadrants;
    double ring;  // without its worst quarter: a highlight or the image border may take one away
  };
  // Means over what is in view; 1 of ring and quadrants when nothing of them is.
  Means MeansInView() const;
};

// How well an image agrees with the pattern under a pose: of the local contrasts those that stand
// in the image as in the print. Not in view is what the image shows less than a fifth of.
struct PatternMatch {
  // Arms: darker than the white on both sides of them; not in view either where something dark
  // hides both, nor when a half of an arm lies in a highlight. White: brighter than ring and arms.
  // Ring: darker than the white around it.
  PartShares shares;
  double contrast = 0;  // of ring and white, gray values, median
  double seen = 0;      // share of all contrasts that the image shows

  // The least of the means of arms, white and ring.
  double Agreement() const;
};

// Compares an image with the print at fixed places: differences of gray values between neighbours
// that should be white and black, so that light which changes over the print, a shadow or a
// highlight spoils only the few that it crosses.
class PatternMatcher {
 public:
  explicit PatternMatcher(const LandingPattern& pattern);

  // Half the side of the square that a view must cover.
  double extent_m() const { return extent_m_; }

  // Median contrast, gray values, of the ring and the white around it, however the pattern is
  // turned: what is worth a look before any other. 0 when less than a sixth of the ring is in view
  // and where there is no white inside. Does not allocate.
  double RingContrast(const cv::Mat& image, const PatternView& view) const;

  // 'view': of the pattern's frame, x along an arm. Does not allocate.
  PatternMatch Match(const cv::Mat& image, const PatternView& view) const;

 private:
  // Which places should be dark and which should be white; the two of a kind may be one.
  struct Contrast {
    int quarter;
    std::array<std::size_t, 2> dark;    // the darker counts
    std::array<std::size_t, 2> bright;  // the darker counts
  };
  std::size_t AddPlace(double x_m, double y_m);

  double extent_m_ = 0;
  // Places of the plane, looked at all at once: those inside of the ring, on it and outside of it
  // first, then those of the cross.
  std::vector<float> x_m_;
  std::vector<float> y_m_;
  std::vector<Contrast> ring_;
  std::vector<Contrast> arms_;
  std::vector<Contrast>
      quadrants_;  // kQuadrantTurns directions of kQuadrantRadii places, by quadrant
};

}  // namespace kestrel
