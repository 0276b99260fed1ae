// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/image/log_gray.h"
#include "kestrel/vision/helipad/helipad.h"
#include "kestrel/vision/tags/board_model.h"
#include "kestrel/vision/tags/board_samples.h"

namespace kestrel {

// The parts of an H and of its surroundings that are examined one by one: no part may be wrong.
enum class HelipadPart {
  kLeftLeg,
  kRightLeg,
  kBar,
  kUpperGap,
  kLowerGap,
  kLeft,
  kRight,
  kAbove,
  kBelow,
  kBarEnds,
  kFrame
};
inline constexpr std::size_t kHelipadParts = 11;
inline constexpr std::size_t kMostHelipadSamples = 256;

// A point whose gray value is examined.
struct HelipadSample {
  Eigen::Vector2d place;  // frame P
  HelipadPart part;
  bool ink;                           // on the H or its frame
  std::vector<std::size_t> opposite;  // indices of the samples of the other colour beside it
};

// Area and second moments of a plane figure about its centroid.
struct FigureMoments {
  double area = 0;  // of either sign, as the border goes around
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();

  // The same for all affine images of a figure: 1 for an ellipse, less for what is less compact.
  double Compactness() const;
};
FigureMoments MomentsOf(std::span<const Eigen::Vector2d> corners);

// Agreement of the gray values of the samples with the H.
struct HelipadAgreement {
  // Natural logarithm of how much likelier an H of one ink on one ground is than any gray values:
  // -n/2 log(1 - r^2) - k/2 log n. r: LikenessOf, so that 1 - r^2 is the share of the contrasts'
  // squares that the H does not explain, noise and unequal ink among it. n: the number of
  // independent samples, one for each area that the blur makes alike. k = 6: the pose was fitted to
  // the same gray values (Schwarz, Estimating the dimension of a model, 1978).
  double evidence = 0;
  double worst_share = 1;  // of the samples of a part, those that agree, in the worst part
  int parts = 0;           // number of parts in view
};

// All that a detector reads of a helipad, computed once.
struct HelipadModel {
  // 'helipad' must be valid.
  explicit HelipadModel(const Helipad& helipad);

  // Compares gray values of all samples, negative where out of view, with the H. A sample is held
  // against those of the other colour beside it, so that the edge of a shadow does not matter.
  // 'stroke_px': width of a stroke in the image.
  HelipadAgreement Compare(std::span<const float> gray, double stroke_px, DimSample dim) const;

  // Returns how much gray values of all samples, negative where out of view, look like the H: the
  // mean contrast of a sample over its root mean square, 1 where all have the same.
  double LikenessOf(std::span<const float> gray) const;

  bool white = true;  // the ink
  BoardModel edges;   // its first tag is the H, its second one the frame where there is one
  std::vector<HelipadSample> samples;
  std::vector<Eigen::Vector2d> places;  // of the samples
  double sample_area = 0;               // on the H, for each of its samples, squares of a stroke
  FigureMoments letter_moments;         // of the H
  FigureMoments frame_moments;          // of all within the frame's outer edge; no area without one

 private:
  // Contrast of a sample with those of the other colour beside it, positive as it should be; NaN
  // where it or they are out of view.
  struct Contrast {
    float mean, largest;
  };
  Contrast ContrastAt(std::span<const float> gray, std::size_t i) const;
  double EvidenceOf(std::span<const float> gray, double stroke_px) const;

  LogGrays log_;
};

}  // namespace kestrel
