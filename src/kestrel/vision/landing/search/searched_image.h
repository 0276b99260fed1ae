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
#include "kestrel/vision/landing/search/frame_noise.h"
#include "kestrel/vision/landing/search/search_plan.h"
#include "kestrel/vision/target/search_log.h"

namespace kestrel {

// Memory of SearchedImage. Does not allocate for images of the size that it was reserved for.
struct SearchedImageBuffers {
  int width_px = 0;
  int height_px = 0;
  NoiseFilter noise;
  TilePyramid pyramid;
  LocalThreshold threshold;
  BlackTopHat top_hat;
  BinaryImage binary;
  std::array<BorderTracer, kSearchPasses> tracers;  // one per pass

  // Reserves memory for images of the size of 'image'; true when the size is new.
  bool Reserve(const cv::Mat& image);
  std::size_t most_points() const;  // points in the borders of a pass with arcs
};

// Writes the dark and bright pixels of a pass to 'buffers->binary'. Needs 'buffers->pyramid' up to
// the pass's 'tile_level' + 2.
void Binarize(const SearchPass& pass, SearchedImageBuffers* buffers);

// The size of the rings that are searched for. Strokes hardly wider than the blur need every pixel,
// and wide ones an image without noise.
enum class RingSize { kSmall, kNear };

// The part of an image that is searched: its pyramid of resolutions and the borders of its dark
// areas.
class SearchedImage {
 public:
  // 'image': CV_8UC1. Image, buffers and log must outlive this.
  SearchedImage(const cv::Mat& image, SearchedImageBuffers* buffers, SearchLog* log);

  // Selects the part to search, without its noise for near rings. Prepare builds its pyramid up to
  // 'last_level'.
  void Choose(const cv::Rect& part, RingSize size);
  void Prepare(int last_level = TilePyramid::kLevels - 1);

  const cv::Mat& whole() const { return *chosen_; }
  const cv::Rect& part() const { return part_; }

  // The part at 1 / 2^level of the resolution, and its location in the image.
  cv::Mat At(int level) const { return buffers_.pyramid.ImageAt(level); }
  ImageRegion RegionAt(int level) const { return {part_.tl(), level}; }

  // Returns the borders of a pass, those of the highest contrast first. Traced at the first call.
  const BorderTracer& Borders(std::size_t pass);

 private:
  const cv::Mat& image_;
  SearchedImageBuffers& buffers_;
  const cv::Mat& without_noise_;
  const cv::Mat* chosen_ = nullptr;
  SearchLog& log_;
  cv::Rect part_;
  int prepared_level_ = -1;
  std::array<bool, kSearchPasses> is_traced_{};
};

}  // namespace kestrel
