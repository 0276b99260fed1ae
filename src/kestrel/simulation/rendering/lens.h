// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/simulation/scene/drawing.h"

namespace kestrel {

// The part of the lens that the camera model does not describe.
struct LensOptions {
  // Largest angle to the optical axis at which light arrives, degrees, (0, 180]. Pixels beyond it,
  // and pixels without a ray in the camera model, are black.
  double half_angle_deg = 92.5;
  // Part of the light that is lost at that angle, 0 to 1; the loss is proportional to the fourth
  // power of the angle.
  double vignette = 0.3;
  // Parts of the airframe in front of the lens, drawn in pixels, and their radiance in units of
  // white, 0 to 1.
  Drawing airframe;
  double airframe_radiance = 0.1;

  std::vector<std::string> Validate() const;
};

// A camera with its lens: the direction of each pixel, and the light that gets through. Immutable
// and thread-safe.
class Lens {
 public:
  // Throws InputError when the options are not valid.
  explicit Lens(const CameraModel& camera, const LensOptions& options = {});

  const CameraModel& camera() const { return camera_; }
  const LensOptions& options() const { return options_; }

  // CV_32F: part of the light that passes the lens, 0 to 1; 0 where the camera is dark.
  const cv::Mat& gain() const { return gain_; }
  // CV_32F: part of a pixel that the airframe covers, 0 to 1.
  const cv::Mat& airframe_cover() const { return airframe_cover_; }

  // Returns the rays of the upper left, upper right, lower left and lower right corner of a pixel
  // with a gain above 0.
  std::array<Eigen::Vector3f, 4> PixelCorners(int u, int v) const;

  // True when a point is visible in the image: inside of it and of the lens circle, not behind the
  // airframe.
  bool Sees(const Eigen::Vector3d& point_in_camera) const;

 private:
  double GainAt(int u, int v) const;

  CameraModel camera_;
  LensOptions options_;
  // Rays of the pixels' corners, row by row; zero where there is none.
  std::vector<Eigen::Vector3f> corner_rays_;
  cv::Mat gain_;
  cv::Mat airframe_cover_;
};

// Two landing legs that reach into the image from its lower corners, as in the paper's frames;
// 'four': also from the upper corners. In pixels, for LensOptions::airframe.
Drawing LandingLegs(const CameraIntrinsics& camera, bool four);

}  // namespace kestrel
