// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/camera/picture_quality.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace kestrel {

PictureQuality MeasurePicture(const cv::Mat& gray) {
  constexpr double kWhite = 255;
  constexpr double kLeastDeviation = 1;  // gray values: of less, noise is all there is
  PictureQuality quality;
  cv::Scalar mean, deviation;
  cv::meanStdDev(gray, mean, deviation);
  quality.brightness = 100 * mean[0] / kWhite;
  cv::Mat is_clipped = (gray == 0) | (gray == 255);
  quality.clipped = 100.0 * cv::countNonZero(is_clipped) / static_cast<double>(gray.total());
  // Without the noise of single pixels.
  cv::Mat smooth, edges;
  cv::GaussianBlur(gray, smooth, {3, 3}, 0);
  cv::Laplacian(smooth, edges, CV_16S);
  cv::Scalar ignored, of_edges;
  cv::meanStdDev(edges, ignored, of_edges);
  constexpr double kMost = 4;  // largest spread of its Laplacian, in deviations of the gray values
  quality.sharpness = 100 * of_edges[0] / (kMost * std::max(deviation[0], kLeastDeviation));
  return quality;
}

}  // namespace kestrel
