// SPDX-License-Identifier: BSD-3-Clause
#include "landing_peers.h"

#include <opencv2/imgproc.hpp>

namespace kestrel {

void ThresholdImage(const cv::Mat& image, cv::Mat* binary) {
  constexpr int kBox = 11;
  cv::adaptiveThreshold(image, *binary, 255, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY_INV,
                        kBox, 5);
}

void ArucoSearch::Search(const cv::Mat& image) {
  cv::aruco::detectMarkers(image, dictionary_, corners_, ids_);
}

}  // namespace kestrel
