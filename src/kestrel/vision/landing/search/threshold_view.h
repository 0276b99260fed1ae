// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <opencv2/core.hpp>

namespace kestrel {

struct SearchedImageBuffers;

// Draws what the search for the landing pattern takes for dark and for bright. Looks at the whole
// image, as a search without a hint does. For use by one thread.
class ThresholdView {
 public:
  ThresholdView();
  ~ThresholdView();

  // Returns an image of the size and type (CV_8UC1) of 'image': 0 dark, 255 bright, 128 undecided,
  // by the first pass of the search with a plain threshold at 1 / 2^level of the resolution,
  // 'level' 0 to 3. Empty for an image of another type.
  cv::Mat Draw(const cv::Mat& image, int level);

 private:
  std::unique_ptr<SearchedImageBuffers> buffers_;
};

}  // namespace kestrel
