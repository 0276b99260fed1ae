// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/image/binary_image.h"
#include "kestrel/core/image/bit_image.h"

namespace kestrel {

// A vertex of the grid between the pixels: (x, y) is the upper left corner of pixel (x, y), at the
// image point (x - 0.5, y - 0.5).
struct GridPoint {
  std::int16_t x;
  std::int16_t y;
};

// A closed border between dark and other pixels: a walk over grid vertices in unit steps, with the
// dark pixels on its right. The outer border of a dark area has a positive area, the border of a
// hole a negative one.
struct Border {
  std::size_t first = 0;  // index of its first point in the tracer
  std::size_t count = 0;
  std::int32_t signed_area = 0;  // pixels
  GridPoint min{};               // bounding box of the vertices
  GridPoint max{};
};

// Limits on the borders that are traced.
struct BorderLimits {
  std::size_t min_count = 10;  // number of points
  int min_extent = 4;          // least width and height of the bounding box, pixels
  int max_extent = 1 << 14;    // largest width or height of the bounding box, pixels
  bool narrow = false;  // also traces borders beside bright strokes of less than three pixels
};

class BorderWalks;

// Traces every border of a binary image once (border following, after Suzuki and Abe 1985, on the
// cracks between the pixels: 8-connected dark areas, 4-connected holes). A border is followed only
// if, somewhere along an upper edge of it, the three pixels two above are bright; two of them
// suffice with BorderLimits::narrow. Other borders, between barely dark and barely not dark pixels,
// are texture.
class BorderTracer {
 public:
  // Reserves memory for an image. Borders that do not fit into half as many points as the image has
  // pixels are given up. Trace on images of at most this size does not allocate.
  void Reserve(int width, int height);

  // Traces the borders in 'region' and keeps those within the limits.
  void Trace(const BinaryImage& binary, const cv::Rect& region, const BorderLimits& limits);

  // Keeps 'most' of the borders, those with the largest contrast, in falling order. The contrast is
  // the median over places along the border of the gray value 1.5 px outside minus that 0.5 px
  // inside. 'image': the one from which the binary image was made. Does not allocate after Reserve.
  void KeepStrongest(const cv::Mat& image, std::size_t most);

  // Removes all borders.
  void Clear() {
    borders_.clear();
    used_ = 0;
  }

  // Number of points for which there is memory.
  std::size_t capacity() const { return points_.size(); }

  // Size of the image that was traced last.
  cv::Size image_size() const { return {traced_.width(), traced_.height()}; }

  const std::vector<Border>& borders() const { return borders_; }
  const GridPoint* begin(const Border& border) const { return points_.data() + border.first; }

 private:
  std::span<GridPoint> Room();
  void TraceFrom(const BorderWalks& walks, int x, int y, const BorderLimits& limits);

  BitImage traced_;  // pixels whose upper edge a walk has passed
  std::vector<Border> borders_;
  std::vector<GridPoint> points_;
  std::size_t used_ = 0;  // number of points in use
  struct Strength {
    int contrast;
    Border border;
  };
  std::vector<Strength> strengths_;
};

}  // namespace kestrel
