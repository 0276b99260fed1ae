// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/landing/landing_pattern.h"
#include "kestrel/landing/pattern_view.h"

namespace kestrel {

// How well an image agrees with the pattern under a pose, quarter by quarter of the print: quarter
// k is the right angle around arm k.
struct PatternMatch {
  // Share, 0 to 1, of the local contrasts of each quarter that stand in the image as in the print;
  // negative when the image shows less than a fifth of it.
  std::array<double, 4> arm{};       // arm darker than the white on both of its sides; not seen
                                     // where something dark hides both, nor when a half of it
                                     // lies in a highlight
  std::array<double, 4> quadrant{};  // white between the arms brighter than ring and arms
  std::array<double, 4> ring{};      // ring darker than the white around it
  int spokes = 0;                    // quadrants with a dark line where all should be white
  double contrast = 0;               // of ring and white, gray values, median
  double seen = 0;                   // share of all contrasts that the image shows

  // What the shares say together, 0 to 1: the least of the means over arms, quadrants and quarters
  // of the ring (but the worst: a highlight or the image border may take one away), less a part of
  // what the worst arm lacks, because an arm that is not there at all makes another sign. The ring
  // and the quadrants count as far as they are in view. 0 when no arm can be seen, and for spokes
  // in two quadrants.
  double Quality() const;

  // Mean over the quarters of the ring that are in view, but the worst; 1 when none is.
  double RingShare() const;
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
