// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"

namespace kestrel {

class PrintOutline;

// A point of the print's outline in an image. It fixes the outline across its direction, but not
// along it.
struct LensEdge {
  Eigen::Vector2d on_print;  // in the pattern's plane, m
  Eigen::Vector2d pixel;
  Eigen::Vector2d across;  // unit normal of the outline in the image, from black to white
};

// The edges of one image of the pattern.
struct LensView {
  std::string name;
  std::vector<LensEdge> edges;
  RigidTransform camera_from_target;  // approximate
};

// Finds the edges of the pattern in images.
class LensViewFinder {
 public:
  // 'camera': may be a guess. It only has to be good enough for the detection of the pattern; the
  // positions of the edges depend on the image alone (AlignPrint). Throws InputError when camera or
  // options are not valid.
  LensViewFinder(const CameraIntrinsics& camera, const LandingPatternDetectorOptions& options);
  ~LensViewFinder();
  LensViewFinder(LensViewFinder&&) noexcept;
  LensViewFinder& operator=(LensViewFinder&&) noexcept;

  // 'image': CV_8UC1 of the camera's size. Returns nothing when the pattern is not found, or is too
  // small for its edges to be found.
  std::optional<LensView> Find(const std::string& name, const cv::Mat& image);

 private:
  LandingPatternDetector detector_;
  std::unique_ptr<const PrintOutline> outline_;
  LandingWorkspace workspace_;
};

}  // namespace kestrel
