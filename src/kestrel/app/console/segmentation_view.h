// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/vision/objects/color_grid.h"
#include "kestrel/vision/objects/object_detector.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/objects/segmentation.h"

namespace kestrel {

// What the object detector takes the pixels for, as a picture. By one thread.
class SegmentationView {
 public:
  // Model and options are valid.
  SegmentationView(const ObjectModel& model, const ObjectDetectorOptions& options);

  // As large as 'image', CV_8UC3 (BGR), and of that type. In their colour, which is the brightest
  // of that hue: the segments that the detector tests; half as bright: pixels of that colour in
  // none of them, which are too few; else the image in gray, dark, and less so where a pixel is
  // ambiguous. Empty for any other image.
  cv::Mat Draw(const cv::Mat& image);

 private:
  void DrawLabels(const cv::Mat& image, cv::Mat* view) const;
  void DrawSegments(const cv::Mat& image, cv::Mat* view);

  ObjectModel model_;
  ColorGrid grid_;
  std::size_t min_pixels_;
  SegmentationWorkspace workspace_;
  std::vector<cv::Vec3b> colors_;  // of the labels from 1
};

}  // namespace kestrel
