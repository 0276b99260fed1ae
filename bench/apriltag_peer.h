// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <apriltag/apriltag.h>
#include <opencv2/core.hpp>

namespace kestrel {

// Corners of a tag in an image, px, from the lower left anticlockwise.
using TagCorners = std::array<Eigen::Vector2d, 4>;

// libapriltag with one family and one thread, at 1 / 'decimate' of the image's size.
class AprilTagPeer {
 public:
  struct Tag {
    int id;
    TagCorners corners;
  };

  AprilTagPeer(const std::string& family, float decimate);
  std::vector<Tag> Find(const cv::Mat& image) const;

 private:
  // The detector refers to the family, which must outlive it.
  std::shared_ptr<apriltag_family_t> family_;
  std::shared_ptr<apriltag_detector_t> detector_;
};

}  // namespace kestrel
