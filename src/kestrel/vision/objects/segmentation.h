// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/vision/objects/color_grid.h"

namespace kestrel {

struct PixelPosition {
  std::int16_t u;
  std::int16_t v;
};

// A connected (4 neighbours) area of one colour.
struct Segment {
  ColorLabel label = kBackgroundLabel;
  std::span<const PixelPosition> pixels;  // in the workspace, until its next segment
  int ambiguous_pixels = 0;               // the last so many of 'pixels' have the ambiguous label
  int min_u = 0, max_u = 0, min_v = 0, max_v = 0;  // bounding box, both ends included
  bool touches_border = false;                     // of the image

  int width() const { return max_u - min_u + 1; }
  int height() const { return max_v - min_v + 1; }
};

// Memory of a search; keeps its size from frame to frame.
class SegmentationWorkspace {
 public:
  // Forgets what the last frame's pixels were: a new stamp, not a new buffer.
  void Start(const cv::Size& size);

 private:
  friend class SegmentSearch;

  cv::Size size_;
  std::vector<std::uint16_t> stamps_;  // equal to 'stamp_': the pixel belongs to a segment
  std::uint16_t stamp_ = 0;
  std::vector<PixelPosition> queue_;
  struct Extent {
    int min;
    int max;
  };
  std::vector<Extent> rows_;
  std::vector<Extent> columns_;
};

// Largest side of an image: positions are 16 bits.
inline constexpr int kMaxImageSide = 32767;

// Finds the segments of one image (paper, Algorithms 3 and 4). Pixels are labelled when they are
// looked at, by the grid; no image of labels is made.
class SegmentSearch {
 public:
  // 'image' CV_8UC3 (BGR), sides up to kMaxImageSide. All three must outlive the search; one search
  // at a time per workspace.
  SegmentSearch(const cv::Mat& image, const ColorGrid& grid, SegmentationWorkspace* workspace);

  // Starts the complete search: every 'step'-th pixel of every 'step'-th row is looked at, every
  // second row shifted by half a step. A segment that holds none of these pixels is not found, see
  // SearchStep; with 1 this is Algorithm 4 as printed.
  void SearchAll(int step);

  // The next segment of the complete search, in the order of rows; false at the end.
  bool Next(Segment* segment);

  // The segment nearest to a pixel, looked for up to 'radius_px' from it and nowhere else (the
  // paper's mode 'track'); false when there is none that was not given out before. 'label': of this
  // colour only, when it is given.
  bool FindNear(int u, int v, int radius_px, std::optional<ColorLabel> label, Segment* segment);

  // Adds the ambiguous pixels that the segment encloses: those that have pixels of it on both sides
  // in their row and in their column.
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

// The largest step of SearchAll with which no filled ellipse of at least 'min_pixels' pixels and of
// axes up to 2 : 1 is missed. Its shorter axis is d = sqrt(2 min_pixels / pi) long; the pixels
// looked at lie on a lattice whose widest empty circle is at most 1.3 steps across.
int SearchStep(int min_pixels);

}  // namespace kestrel
