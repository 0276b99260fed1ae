// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/vision/objects/color/color_grid.h"

namespace kestrel {

struct PixelPosition {
  std::int16_t u;
  std::int16_t v;
};

// A connected area (4 neighbours) of one colour.
struct Segment {
  ColorLabel label = kBackgroundLabel;
  std::span<const PixelPosition> pixels;  // in the workspace, valid until the next segment
  int ambiguous_pixels = 0;  // number of pixels with the ambiguous label, last in 'pixels'
  int min_u = 0, max_u = 0, min_v = 0, max_v = 0;  // bounding box, inclusive
  bool touches_border = false;                     // touches the image border

  int width() const { return max_u - min_u + 1; }
  int height() const { return max_v - min_v + 1; }
};

// Memory of a search. It keeps its size from frame to frame.
class SegmentationWorkspace {
 public:
  // Starts a new frame: a new stamp marks all pixels as unused without clearing a buffer.
  void Start(const cv::Size& size);

 private:
  friend class SegmentSearch;

  cv::Size size_;
  std::vector<std::uint16_t> stamps_;  // equal to 'stamp_' where the pixel belongs to a segment
  std::uint16_t stamp_ = 0;
  std::vector<PixelPosition> queue_;
  struct Extent {
    int min;
    int max;
  };
  std::vector<Extent> rows_;
  std::vector<Extent> columns_;
};

// Largest side of an image, which PixelPosition can hold.
inline constexpr int kMaxImageSide = std::numeric_limits<std::int16_t>::max();

// Finds the segments of one image (paper, Algorithms 3 and 4). The grid labels pixels when they are
// visited; no image of labels is made.
class SegmentSearch {
 public:
  // 'image': CV_8UC3 (BGR), sides up to kMaxImageSide. All three must outlive the search. One
  // search at a time per workspace.
  SegmentSearch(const cv::Mat& image, const ColorGrid& grid, SegmentationWorkspace* workspace);

  // Starts the complete search. It visits every 'step'-th pixel of every 'step'-th row, with every
  // second row shifted by half a step. Segments without any of these pixels are not found, see
  // SearchStep. With step 1 this is Algorithm 4 as printed.
  void SearchAll(int step);

  // Gives the next segment of the complete search, in the order of rows; false at the end.
  bool Next(Segment* segment);

  // Gives the segment nearest to a pixel, searched only up to 'radius_px' around it (the paper's
  // mode 'track'). False when there is none that was not given before. 'label': searches this
  // colour only.
  bool FindNear(int u, int v, int radius_px, std::optional<ColorLabel> label, Segment* segment);

  // Adds the ambiguous pixels that the segment encloses: those with pixels of it on both sides in
  // their row and in their column.
  void JoinAmbiguous(Segment* segment);

 private:
  bool IsNewObject(int u, int v, ColorLabel* label) const;
  void FloodFill(int u, int v, ColorLabel label, Segment* segment);
  void Push(int u, int v, ColorLabel label, int* end);
  ColorLabel LabelAt(int u, int v) const { return grid_.At(image_.ptr(v) + 3 * u); }
  std::uint16_t& StampAt(int u, int v) const {
    return workspace_->stamps_[static_cast<std::size_t>(v) * image_.cols + u];
  }

  const cv::Mat& image_;
  const ColorGrid& grid_;
  SegmentationWorkspace* workspace_;
  int step_ = 1;
  int u_ = 0;
  int v_ = 0;
};

// Returns the largest step for which SearchAll finds every filled ellipse of at least 'min_pixels'
// pixels and axes up to 2 : 1. Its shorter axis is d = sqrt(2 min_pixels / pi) long. The largest
// empty circle of the lattice of visited pixels has a diameter of at most 1.3 steps.
int SearchStep(int min_pixels);

}  // namespace kestrel
