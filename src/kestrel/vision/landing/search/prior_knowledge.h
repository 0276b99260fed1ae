// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/cone.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/landing/location/pattern_locator.h"
#include "kestrel/vision/landing/search/search_plan.h"

namespace kestrel {

// The knowledge in the hint: where to look first, which of two poses is right, and which findings
// are less probable. The hint may be wrong; a pattern in plain view is found all the same.
class PriorKnowledge {
 public:
  // 'hint' must outlive this.
  PriorKnowledge(const TargetHint& hint, const LandingPatternDetectorOptions& options,
                 const CameraModel& camera);

  // Returns the part of the image that the board may take when the centre has the standard
  // deviation 'sigma_m' per axis. Nothing without a centre in the hint, or when it is out of the
  // image.
  std::optional<cv::Rect> PartOfImage(double sigma_m) const;

  // As kestrel::PartBelowHorizon; nothing where the hint has no sky.
  std::optional<cv::Rect> PartBelowHorizon() const;

  // Returns the predicted ring. Nothing when the hint lacks centre or up, or shows the ring from
  // below.
  std::optional<CirclePose> PredictedRing() const;

  // True when a step may find a ring of the expected size.
  bool Suits(const SearchStep& step) const;

  // Returns the change in log odds due to the distance of a pattern: 0, or negative where it
  // contradicts the hint.
  double LogOddsOfDistance(const Eigen::Vector3d& center_in_camera) const;

  // The order in which the two poses of a ring are tested: the more level one first.
  // 'one_is_right': the hint distinguishes the poses, so the second one is tested only where the
  // first one fails.
  struct Order {
    std::array<int, 2> poses{0, 1};
    bool one_is_right = false;
  };
  Order OrderOf(const std::array<CirclePose, 2>& poses) const;

  // Returns the prior of the pattern's normal; nothing where 'normal', that of the ring seen,
  // contradicts the hint.
  std::optional<NormalPrior> LevelPrior(const Eigen::Vector3d& normal) const;

  // Returns the direction away from the ground. Without an attitude the camera is assumed to look
  // straight down.
  Eigen::Vector3d Up() const;

 private:
  double ExpectedRingPx() const;

  const TargetHint& hint_;
  const CameraModel& camera_;
  double radius_m_;
  double level_sigma_;
  double max_partial_altitude_m_;
  double expected_ring_px_ = 0;  // diameter of a ring that faces the camera; 0: not known
};

}  // namespace kestrel
