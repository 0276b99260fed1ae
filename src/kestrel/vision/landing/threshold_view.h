// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <opencv2/core.hpp>

namespace kestrel {

struct SearchedImageBuffers;

// What the search for the landing pattern takes for dark and what for bright, as a picture. The
// whole image is looked at, as the search does when nothing tells it where the pattern is. By one
// thread.
class ThresholdView {
 public:
  ThresholdView();
  ~ThresholdView();

  // As large as 'image' (CV_8UC1), of that type: 0 dark, 255 bright, 128 undecided; by the first
  // pass of the search that looks at 1 / 2^level of the resolution, 'level' 0 to 3. Empty for any
  // other image.
  cv::Mat Draw(const cv::Mat& image, int level);

 private:
  std::unique_ptr<SearchedImageBuffers> buffers_;
};

}  // namespace kestrel
