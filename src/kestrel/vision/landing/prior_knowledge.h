// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/cone.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/landing/pattern_locator.h"
#include "kestrel/vision/landing/search_plan.h"

namespace kestrel {

// What the hint says. It tells where to look first, which of two poses is right and what is less
// probable; it may be wrong, and what is in plain view is found all the same.
class PriorKnowledge {
 public:
  // 'hint' must outlive it.
  PriorKnowledge(const LandingHint& hint, const LandingPatternDetectorOptions& options,
                 const CameraModel& camera);

  // The part of the image that the board may take when the centre has this standard deviation;
  // nothing without a centre, or when that is out of the image.
  std::optional<cv::Rect> PartOfImage(double sigma_m) const;

  // The ring as it is predicted, where the hint has a centre and an up that it can have.
  std::optional<CirclePose> PredictedRing() const;

  // Whether a step may find a ring of the size that the hint says.
  bool Suits(const SearchStep& step) const;

  // Logarithm of the odds that a pattern so far away takes or gives.
  double LogOddsOfDistance(const Eigen::Vector3d& center_in_camera) const;

  // The poses of a ring in the order in which they are tested: the one that is level first. The
  // other one is the wrong one, unless the hint is: it is tested where the first fails.
  struct Order {
    std::array<int, 2> poses{0, 1};
    bool one_is_right = false;
  };
  Order OrderOf(const std::array<CirclePose, 2>& poses) const;

  // What is known of the pattern's plane; nothing where the ring that is seen contradicts it.
  std::optional<NormalPrior> LevelPrior(const Eigen::Vector3d& normal) const;

  // Away from the ground: without an attitude the camera is taken to look straight down.
  Eigen::Vector3d Up() const;

 private:
  double ExpectedRingPx() const;

  const LandingHint& hint_;
  const CameraModel& camera_;
  double radius_m_;
  double level_sigma_;
  double max_partial_altitude_m_;
  double expected_ring_px_ = 0;  // diameter of a ring that faces the camera; 0: not known
};

}  // namespace kestrel
