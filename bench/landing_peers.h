// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include <apriltag/apriltag.h>
#include <opencv2/aruco.hpp>
#include <opencv2/core.hpp>

namespace kestrel {

// Known methods that the landing pattern detector is compared with, on the same image and with one
// thread.

// One cv::adaptiveThreshold, mean of a box of 11 pixels.
void ThresholdImage(const cv::Mat& image, cv::Mat* binary);

// AprilTag 3, family 36h11, at 1 / 'decimate' of the image's size.
class AprilTagSearch {
 public:
  explicit AprilTagSearch(float decimate);
  void Search(const cv::Mat& image) const;

 private:
  // The detector refers to the family, which must outlive it.
  std::shared_ptr<apriltag_family_t> family_;
  std::shared_ptr<apriltag_detector_t> detector_;
};

// ArUco, dictionary 6x6_250.
class ArucoSearch {
 public:
  void Search(const cv::Mat& image);

 private:
  cv::Ptr<cv::aruco::Dictionary> dictionary_ =
      cv::aruco::getPredefinedDictionary(cv::aruco::DICT_6X6_250);
  std::vector<std::vector<cv::Point2f>> corners_;
  std::vector<int> ids_;
};

}  // namespace kestrel
