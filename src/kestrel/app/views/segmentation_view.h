// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/vision/objects/color/color_grid.h"
#include "kestrel/vision/objects/object_detector.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/objects/segmentation/segmentation.h"

namespace kestrel {

// Draws how the object detector segments an image. Call it from one thread.
class SegmentationView {
 public:
  // Model and options are valid.
  SegmentationView(const ObjectModel& model, const ObjectDetectorOptions& options);

  // Returns a picture of the size of 'image', both CV_8UC3 (BGR). Segments that the detector tests
  // have their colour at full brightness; pixels with a label that are in no segment, or in one
  // that is too small, have half of it. Ambiguous pixels are dimmed gray, background pixels darker
  // gray. Empty for any other image.
  cv::Mat Draw(const cv::Mat& image);

 private:
  void DrawLabels(const cv::Mat& image, cv::Mat* view) const;
  void DrawSegments(const cv::Mat& image, cv::Mat* view);

  ObjectModel model_;
  ColorGrid grid_;
  std::size_t min_pixels_;
  SegmentationWorkspace workspace_;
  std::vector<cv::Vec3b> colors_;  // colours of the labels from 1
};

}  // namespace kestrel
