// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"

namespace kestrel {

enum class RegionState {
  kFollowing,  // seen in this image
  kCoasting,   // not seen in this image, and for at most 0.5 s: the box is a prediction
  kLost,       // looked for in the image, in ever larger parts of it
};
const char* ToString(RegionState state);

// Where the region is expected, from its motion in the world and the pose of the camera.
struct RegionHint {
  Eigen::Vector2d center_px;
  Eigen::Matrix2d covariance_px2;
};

struct RegionReport {
  RegionState state = RegionState::kLost;
  // Around the region, px: as marked, the pixel (x, y) is its upper left one. Of the last place
  // when it is lost.
  cv::Rect2d box_px;
  double probability = 0;  // that the box is on what was marked
};

// Follows a region of an image that a person has marked, by its appearance: whatever it shows.
//
// A correlation filter (see AppearanceFilter) on gradients, gray and colour finds it around the
// place that is expected, at three scales. It learns what it finds unless that is ambiguous. Where
// the colours of the region differ from those around it they show its form (see RegionColors), and
// vouch for what the filter hardly knows. A second filter, which learns slowly from the marked
// image on, decides whether it still is the marked thing, and finds it again when it was lost. A
// hint takes the UAV's own motion out of the expected place; without one, the shift of the
// background is estimated from the images.
class RegionTracker {
 public:
  RegionTracker();
  ~RegionTracker();
  RegionTracker(RegionTracker&&) noexcept;
  RegionTracker& operator=(RegionTracker&&) noexcept;

  // Starts on a region of an image, in place of any before. 'image': CV_8UC1, or CV_8UC3 in the
  // order BGR. 'box_px': the pixel (x, y) is its upper left one; at least 4 px wide and high, its
  // middle within the image. Throws InputError when image or box are not as expected.
  void Mark(const cv::Mat& image, Time time, const cv::Rect2d& box_px);

  // Finds the region in a later image of the same type and size. Before Mark, and for an image of
  // another type or size, reports it as lost. Does not allocate.
  RegionReport Track(const cv::Mat& image, Time time,
                     const std::optional<RegionHint>& hint = std::nullopt);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kestrel
