// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/target/landing_detection.h"
#include "kestrel/vision/target/target_detector.h"

namespace kestrel {

struct LandingPatternDetectorOptions {
  LandingPattern pattern;
  // Smallest minor axis (diameter) of a ring that is searched for, px. Smaller values are slower
  // and raise the danger of look-alikes.
  double min_ring_px = 6;
  // Smallest accepted quality, 0 to 1: the probability that it is the pattern.
  double min_quality = 0.7;
  // Standard deviation per axis of the pattern's tilt from level. The image hardly shows the tilt
  // of a far pattern, and its distance depends on the tilt. Used where the hint has up_in_camera.
  // Larger for a deck that rolls, smaller for a floor.
  double level_sigma_deg = 3;
  // Height of the camera (m) up to which a partial pattern is searched for, where the height is
  // known.
  double max_partial_altitude_m = 2.5;
  // Time (ms) after which the search of a frame stops, to continue in the next one; 0: the hint's
  // limit.
  double max_search_ms = 0;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor.Group("pattern", self.pattern);
    visitor("min_ring_px", self.min_ring_px, "px",
            "smallest minor axis of a ring that is searched for");
    visitor("min_quality", self.min_quality, "1",
            "smallest probability of the pattern that is accepted, 0 to 1");
    visitor("level_sigma_deg", self.level_sigma_deg, "deg",
            "tilt of the pattern from level, standard deviation");
    visitor("max_partial_altitude_m", self.max_partial_altitude_m, "m",
            "largest height at which a pattern cut off by the image border is searched for");
    visitor("max_search_ms", self.max_search_ms, "ms",
            "longest search in one frame, which the next frame continues; 0: no limit, in flight "
            "the rest of the camera's period");
  }
  std::vector<std::string> Validate() const;
};

// Memory of one thread's detections. It grows in the first frames and is kept.
class LandingWorkspace final : public TargetWorkspace {
 public:
  LandingWorkspace();
  ~LandingWorkspace() override;
  LandingWorkspace(LandingWorkspace&&) noexcept;
  LandingWorkspace& operator=(LandingWorkspace&&) noexcept;

  struct Buffers;  // of LandingSearch

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
  LandingReport Detect(const cv::Mat& image, const LandingHint& hint,
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
