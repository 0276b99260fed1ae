// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <opencv2/aruco.hpp>
#include <opencv2/core.hpp>

namespace kestrel {

// Known methods that the landing pattern detector is compared with, on the same image and with one
// thread.

// One cv::adaptiveThreshold, mean of a box of 11 pixels.
void ThresholdImage(const cv::Mat& image, cv::Mat* binary);

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
