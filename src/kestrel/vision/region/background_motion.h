// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/vision/region/grid_spectrum.h"

namespace kestrel {

// How far the background moves from image to image, by phase correlation of coarse images (Kuglin
// and Hines, "The phase correlation image alignment method", 1975). Turns and changes of scale are
// not estimated.
class BackgroundMotion {
 public:
  BackgroundMotion();

  // Returns the shift of the background since the image before, px; zero for the first image, for
  // one of another size, and where the images do not agree. Does not allocate.
  Eigen::Vector2d Update(const cv::Mat& image);

 private:
  void Shrink(const cv::Mat& image);

  GridTransform transform_;
  FeatureGrid grid_;
  GridSpectrum current_, previous_, cross_;
  std::vector<float> taper_;  // towards the border, by row and by column
  cv::Size size_;
};

}  // namespace kestrel
