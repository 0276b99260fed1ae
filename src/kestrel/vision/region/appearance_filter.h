// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "kestrel/vision/region/grid_spectrum.h"

namespace kestrel {

// The response of a filter over the displacements of a target from the middle of a window.
struct FilterPeak {
  Eigen::Vector2d displacement = Eigen::Vector2d::Zero();  // cells
  double value = 0;                                        // about 1 for what was learnt
  // Square of the peak over the mean square of the response, both above its least value: APCE of
  // Wang et al., "Large margin object tracking with circulant feature maps" (CVPR 2017).
  double sharpness = 0;
};

// Memory of the filters of one size, which are used one after the other.
struct FilterWorkspace {
  FilterWorkspace(int cells, int channels);

  GridTransform transform, response_transform;
  GridSpectrum prior, spatial, dual, response_spectrum;
  FeatureGrid grid, response;
};

// Tells a target from its background: a correlation filter that is trained on a window around the
// target, all places of which but the target's are negatives, and that is zero where the target is
// not. After Kiani Galoogahi et al., "Learning background-aware correlation filters" (ICCV 2017),
// and Li et al., "Learning spatial-temporal regularized correlation filters" (CVPR 2018):
// minimises |sum_c f_c * x_c - y|^2 + |w f|^2 + temporal |f - f_before|^2 by ADMM.
class AppearanceFilter {
 public:
  AppearanceFilter(int cells, int channels);

  // Forgets what was learnt. 'target': width and height in cells.
  void Reset(const Eigen::Vector2d& target, FilterWorkspace* workspace);
  // Learns that the target is in the middle of a window with the spectrum 'sample'. 'temporal': the
  // weight of what was learnt before.
  void Learn(const GridSpectrum& sample, double temporal, FilterWorkspace* workspace);
  FilterPeak Find(const GridSpectrum& sample, FilterWorkspace* workspace) const;

 private:
  int cells_;
  GridSpectrum filter_;
  std::vector<float> label_;   // the wanted response: its spectrum, which is real
  std::vector<float> weight_;  // w^2 by cell
  bool has_learnt_ = false;
};

}  // namespace kestrel
