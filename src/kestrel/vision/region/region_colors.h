// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "kestrel/vision/region/window_sampler.h"

namespace kestrel {

// The colours of a region, beside those around it: where they differ they show how far the region
// reaches, which changes when it turns, where else it may be, and that something else is in its
// place. The probability of a pixel is that of Possegger et al., "In defense of color-based
// model-free tracking" (CVPR 2015), section 3.1.
class RegionColors {
 public:
  explicit RegionColors(int side);  // of the windows, px

  // A box in a window, px.
  struct Box {
    Eigen::Vector2d middle, size;
  };

  // Learns the colours in the box and around it. Does not allocate.
  void Mark(const SampledWindow& window, const Box& box);
  // Learns the colours around the box. Those in it are learnt once: a box that is too large would
  // take the ground for the region. Does not allocate.
  void LearnAround(const SampledWindow& window, const Box& box);
  // Returns the box that the region's colours show near 'box'; nothing where they end nowhere, are
  // those around it as well, or did not show the box that was marked. Does not allocate.
  std::optional<Box> Fit(const SampledWindow& window, const Box& box);
  // Returns how much of the region's colours, in any light, and not of those around it, is in a
  // box: 1 for as much as usually; half of that, about, where all colours are unknown. Does not
  // allocate.
  double AgreementOf(const SampledWindow& window, const Box& box);
  // The same in the light of the marked image, where a colour counts at most three times as often
  // as in the region: a shadow that the marked box held as well is not the region. Does not
  // allocate.
  double MatchOf(const SampledWindow& window, const Box& box);
  // A box, and by how much it has more of the region's colours than what is around it.
  struct Place {
    Box box;
    double contrast;
  };
  // Returns the place in the window with the largest contrast. Does not allocate.
  Place Find(const SampledWindow& window, const Eigen::Vector2d& size);

 private:
  struct Extent {
    double first, last;
  };
  struct Band {
    int first, last;
  };

  void Count(const SampledWindow& window, const Box& box);
  void Rate();
  bool IsKnown(int color) const;
  float BestInOtherLight(int color) const;
  std::optional<Box> Outline(const SampledWindow& window, const Box& box);
  std::optional<Box> CompareWithOutline(const SampledWindow& window, const Box& box);
  void CountCore(const SampledWindow& window, const Box& box);
  double ShareInAnyLight(const SampledWindow& window, const Box& box);
  void SumUp(const SampledWindow& window);
  double ContrastOf(const Eigen::Vector2i& first, const Eigen::Vector2i& size) const;
  void Project(const SampledWindow& window, int axis, Band across);
  std::optional<Extent> ExtentAlong(int axis, const SampledWindow& window, const Box& box);
  std::optional<double> EndOf(double middle, double half, float edge, int step) const;

  int side_;
  std::vector<float> inside_, around_;          // shares of the colours
  std::vector<float> new_inside_, new_around_;  // of one image
  std::vector<float> probability_;              // that a pixel of a colour is of the region
  std::vector<float> in_any_light_;             // the largest of it, of the colour in other light
  std::vector<float> profile_;                  // its mean across an axis
  std::vector<float> sums_;                     // of it, over all pixels above and left
  // The marked box in sizes of its outline; nothing where the colours did not show it.
  std::optional<Box> marked_;
  double usual_share_ = 1;
  bool has_hues_ = false;  // of a colour image: what is gray has only its brightness
};

}  // namespace kestrel
