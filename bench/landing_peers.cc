// SPDX-License-Identifier: BSD-3-Clause
#include "landing_peers.h"

#include <apriltag/tag36h11.h>
#include <opencv2/imgproc.hpp>

namespace kestrel {

void ThresholdImage(const cv::Mat& image, cv::Mat* binary) {
  constexpr int kBox = 11;
  cv::adaptiveThreshold(image, *binary, 255, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY_INV,
                        kBox, 5);
}

AprilTagSearch::AprilTagSearch(float decimate)
    : family_(tag36h11_create(), tag36h11_destroy),
      detector_(apriltag_detector_create(), apriltag_detector_destroy) {
  apriltag_detector_add_family(detector_.get(), family_.get());
  detector_->nthreads = 1;
  detector_->quad_decimate = decimate;
}

void AprilTagSearch::Search(const cv::Mat& image) const {
  image_u8_t view = {.width = image.cols,
                     .height = image.rows,
                     .stride = static_cast<int>(image.step[0]),
                     .buf = image.data};
  apriltag_detections_destroy(apriltag_detector_detect(detector_.get(), &view));
}

void ArucoSearch::Search(const cv::Mat& image) {
  cv::aruco::detectMarkers(image, dictionary_, corners_, ids_);
}

}  // namespace kestrel
