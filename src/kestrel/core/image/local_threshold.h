// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/image/binary_image.h"

namespace kestrel {

// Smallest, largest and mean gray value of the square tiles of an image, row by row.
struct TileImage {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> minimum;
  std::vector<std::uint8_t> maximum;
  std::vector<std::uint8_t> mean;

  // Resizes to columns x rows tiles, to none when either is 0. Keeps its memory when that is large
  // enough.
  void Reset(int columns, int rows);
};

// Level k holds the tiles of 2^k pixels, computed from those of level k - 1. Tiles that the right
// or lower image border cuts off are left out. The means of a level are the image at a lower
// resolution: ImageAt. Does not allocate once it has seen an image of this size.
class TilePyramid {
 public:
  static constexpr int kLevels = 8;

  // 'image': CV_8UC1, kept by reference until the next Build. Levels above 'last_level' are
  // computed by the next Build that includes them; they must not be read before.
  void Build(const cv::Mat& image, int last_level = kLevels - 1);

  // 'level': 1 to kLevels - 1. Has no tiles where the image is too small for one.
  const TileImage& level(int level) const { return levels_[level]; }

  // The image at 1 / 2^level of its size, 'level' from 0. A view, without a copy.
  cv::Mat ImageAt(int level) const;

 private:
  cv::Mat image_;
  std::array<TileImage, kLevels> levels_;
};

// The adaptive threshold of the paper (section 2.1), decided per tile instead of per pixel. A pixel
// is dark when it is below the mean of the box of 3 x 3 tiles around its own tile, and bright when
// it is nearer to the brightest pixel of the box than to its mean. Where the box has too little
// contrast, a box four times as large decides, so that the inside of a broad dark stroke is dark.
// A pixel is undecided when that has too little contrast as well.
class LocalThreshold {
 public:
  // Definition of dark: as above, or only within a quarter of the contrast above the darkest pixel
  // of the box, which includes black paint but no shadow on white.
  enum class Dark { kBelowMean, kBlack };

  // Computes the boxes for the image at 'image_level' of the pyramid, from tiles of 'tile_level' >
  // image_level. A box is 3 * 2^(tile_level - image_level) pixels of that image wide. Measure and
  // Binarize do not allocate once they have seen an image of this size.
  void Measure(const TilePyramid& pyramid, int image_level, int tile_level);

  // Returns the contrast (largest minus smallest gray value) below which 'share', 0 to 1, of the
  // boxes lie.
  int ContrastQuantile(double share) const;

  // Decides all pixels. 'min_contrast' >= 1: least contrast of a box that decides.
  void Binarize(const cv::Mat& image, int min_contrast, BinaryImage* binary,
                Dark what = Dark::kBelowMean);

 private:
  void ChooseThresholds(int min_contrast, Dark what);
  void ExpandRow(int tile_row, int width);

  int tile_px_ = 0;
  TileImage fine_box_;    // statistics over 3 x 3 tiles
  TileImage coarse_box_;  // the same, tiles four times as large
  Thresholds coarse_;     // per coarse tile, per fine tile, and per pixel of a row
  Thresholds fine_;
  Thresholds row_;
};

}  // namespace kestrel
