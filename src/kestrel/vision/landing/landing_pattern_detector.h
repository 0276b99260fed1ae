// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/target/target_detection.h"
#include "kestrel/vision/target/target_detector.h"

namespace kestrel {

struct LandingPatternDetectorOptions {
  LandingPattern pattern;
  double min_ring_px = 6;
  double min_quality = 0.7;
  double level_sigma_deg = 3;
  double max_partial_altitude_m = 2.5;
  double max_search_ms = 0;

  static void Visit(auto& self, auto&& visit) {
    visit.Group("pattern", self.pattern);
    visit("min_ring_px", self.min_ring_px, Range{4, 1000},
          "smallest minor axis of a ring; less is slower");
    visit("min_quality", self.min_quality, Range{0, 1}, "smallest accepted probability");
    visit("level_sigma_deg", self.level_sigma_deg, Range{0, 90, false, true},
          "tilt from level, standard deviation; larger for a deck that rolls");
    visit("max_partial_altitude_m", self.max_partial_altitude_m, AtLeast(0),
          "largest height at which a pattern cut off by the image border is searched for");
    visit("max_search_ms", self.max_search_ms, AtLeast(0),
          "longest search in one frame, which the next frame continues; 0: no limit, in flight "
          "the rest of the camera's period");
  }
};

// Memory of one thread's detections. It grows in the first frames and is kept.
class LandingWorkspace final : public TargetWorkspace {
 public:
  LandingWorkspace();
  ~LandingWorkspace() override;
  LandingWorkspace(LandingWorkspace&&) noexcept;
  LandingWorkspace& operator=(LandingWorkspace&&) noexcept;

  struct Buffers;  // memory of LandingSearch

 private:
  friend class LandingPatternDetector;
  std::unique_ptr<Buffers> buffers_;
};

// Finds the landing pattern in one image (paper, sections 2.1 to 2.5).
class LandingPatternDetector final : public TargetDetector {
 public:
  // Throws InputError when the options or the camera are not valid.
  LandingPatternDetector(const CameraModel& camera, const LandingPatternDetectorOptions& options);
  ~LandingPatternDetector() override;
  LandingPatternDetector(LandingPatternDetector&&) noexcept;
  LandingPatternDetector& operator=(LandingPatternDetector&&) noexcept;

  // As of TargetDetector. 'workspace': a LandingWorkspace.
  using TargetDetector::Detect;
  TargetReport Detect(const cv::Mat& image, const TargetHint& hint,
                      TargetWorkspace& workspace) const override;
  std::unique_ptr<TargetWorkspace> MakeWorkspace() const override;
  const CameraModel& camera() const override;
  const TargetShape& shape() const override;

  const LandingPatternDetectorOptions& options() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace kestrel
