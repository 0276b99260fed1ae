// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <opencv2/core.hpp>

#include "kestrel/core/image/bit_image.h"
#include "kestrel/core/image/black_top_hat.h"
#include "kestrel/core/image/border_tracing.h"
#include "kestrel/core/image/local_threshold.h"
#include "kestrel/vision/landing/image_region.h"
#include "kestrel/vision/landing/search_log.h"
#include "kestrel/vision/landing/search_plan.h"

namespace kestrel {

// Memory of SearchedImage, which does not allocate for images of the size that it was reserved for.
struct SearchedImageBuffers {
  int width_px = 0;
  int height_px = 0;
  TilePyramid pyramid;
  LocalThreshold threshold;
  BlackTopHat top_hat;
  BinaryImage binary;
  BitImage scratch;
  std::array<BorderTracer, kSearchPasses> tracers;  // of each pass

  // Makes room for images of this one's size; true when there was none.
  bool Reserve(const cv::Mat& image);
  std::size_t most_points() const;  // of the borders of a pass that are cut into arcs
};

// Decides in 'buffers.binary' what a pass takes for dark and for bright, in the image of which
// 'buffers.pyramid' is made up to the pass's 'tile_level' + 2.
void Binarize(const SearchPass& pass, SearchedImageBuffers* buffers);

// The part of an image that is searched: at all resolutions, and the borders of dark areas in it.
class SearchedImage {
 public:
  // 'image': CV_8UC1; it, the buffers and the log must outlive this.
  SearchedImage(const cv::Mat& image, SearchedImageBuffers* buffers, SearchLog* log);

  // Searches this part from now on. Its resolutions are made by Prepare, up to 'last_level'.
  void Choose(const cv::Rect& part);
  void Prepare(int last_level = TilePyramid::kLevels - 1);

  const cv::Mat& whole() const { return image_; }
  const cv::Rect& part() const { return part_; }

  // The part at 1 / 2^level of the resolution, and where it lies in the image.
  cv::Mat At(int level) const { return buffers_.pyramid.ImageAt(level); }
  ImageRegion RegionAt(int level) const { return {part_.tl(), level}; }

  // The borders of a pass, those of the highest contrast first; traced when they are first asked
  // for.
  const BorderTracer& Borders(std::size_t pass);

 private:
  const cv::Mat& image_;
  SearchedImageBuffers& buffers_;
  SearchLog& log_;
  cv::Rect part_;
  int prepared_level_ = -1;
  std::array<bool, kSearchPasses> is_traced_{};
};

}  // namespace kestrel
