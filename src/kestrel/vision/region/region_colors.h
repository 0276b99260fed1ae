// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "kestrel/vision/region/color_shares.h"
#include "kestrel/vision/region/window_sampler.h"

namespace kestrel {

// The colours of a region, beside those around it: where they differ they show how far the region
// reaches, which changes when it turns, where else it may be, and that something else is in its
// place. Brightness changes from sun to shadow, a hue does not.
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
  // True where enough of the marked box has a hue: what is gray is known by its brightness only.
  bool HasHues() const;
  // Returns how much of the region's colours, in any light, and not of those around it, is in a
  // box: 1 for as much as usually; half of that, about, where all colours are unknown; 0 where the
  // region has hues that are missing. Does not allocate.
  double AgreementOf(const SampledWindow& window, const Box& box) const;
  // The same for a region that may have come from a marked box with a shadow, which alone is not
  // the region: one without hues is compared in the light of the marked image, and each hue, or
  // colour, counts at most three times as often as in it. Does not allocate.
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
  float ProbabilityInAnyLight(const SampledWindow& window, std::size_t pixel) const;
  float HueProbability(const SampledWindow& window, std::size_t pixel) const;
  std::optional<Box> Outline(const SampledWindow& window, const Box& box);
  std::optional<Box> CompareWithOutline(const SampledWindow& window, const Box& box);
  double ShareInAnyLight(const SampledWindow& window, const Box& box) const;
  double ShareOfHues(const SampledWindow& window, const Box& box) const;
  bool AreHuesMissing(const SampledWindow& window, const Box& box) const;
  template <typename Visitor>
  int ForEachInCore(const Box& box, const Visitor& visit) const;
  void SumUp(const SampledWindow& window);
  double ContrastOf(const Eigen::Vector2i& first, const Eigen::Vector2i& size) const;
  void Project(const SampledWindow& window, int axis, Band across);
  std::optional<Extent> ExtentAlong(int axis, const SampledWindow& window, const Box& box);
  std::optional<double> EndOf(double middle, double half, float edge, int step) const;

  int side_;
  ColorShares colors_, hues_;
  std::vector<float> core_;     // pixels of each colour, or hue, in the inner part of a box
  std::vector<float> profile_;  // mean probability across an axis
  std::vector<float> sums_;     // of it, over all pixels above and left
  // The marked box in sizes of its outline; nothing where the colours did not show it.
  std::optional<Box> marked_;
  double usual_share_ = 1;
  double marked_hues_ = 0;  // share of the box
};

}  // namespace kestrel
