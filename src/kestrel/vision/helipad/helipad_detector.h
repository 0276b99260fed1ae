// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/helipad/helipad.h"
#include "kestrel/vision/target/target_detector.h"

namespace kestrel {

struct HelipadDetectorOptions : Helipad {
  double min_quality = 0.7;
  double level_sigma_deg = 3;

  static void Visit(auto& self, auto&& visit) {
    Helipad::Visit(self, visit);
    visit("min_quality", self.min_quality, Range{0, 1}, "smallest accepted probability of the pad");
    visit("level_sigma_deg", self.level_sigma_deg, MoreThan(0),
          "tilt from level, standard deviation");
  }
};

// Finds a helipad by its H in the raw image of any lens.
//
// A border of the image is a candidate when its moments, on a plane across the ray to its middle,
// are those of an H or of its frame under an affine map. Gray values along rays then tell how the H
// is turned and whether it is one; all its edges, and those of the frame, give the pose by least
// squares in the image. Where the hint has the orientation, the pad is first looked for by its
// appearance at the expected place, which works on a part of it as well. The heading is known up to
// half a turn.
class HelipadDetector final : public TargetDetector {
 public:
  // Throws InputError when the options or the camera are not valid.
  HelipadDetector(const CameraModel& camera, const HelipadDetectorOptions& options);
  ~HelipadDetector() override;
  HelipadDetector(HelipadDetector&&) noexcept;
  HelipadDetector& operator=(HelipadDetector&&) noexcept;

  // As of TargetDetector. Does not allocate once the workspace has warmed up.
  using TargetDetector::Detect;
  TargetReport Detect(const cv::Mat& image, const TargetHint& hint,
                      TargetWorkspace& workspace) const override;
  std::unique_ptr<TargetWorkspace> MakeWorkspace() const override;
  const CameraModel& camera() const override;
  const TargetShape& shape() const override;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace kestrel
