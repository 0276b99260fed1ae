// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/local_threshold.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/base/test_targets.h"
#include "kestrel/core/image/test_images.h"

namespace kestrel {
namespace {

struct Statistics {
  int minimum = 255;
  int maximum = 0;
  int mean = 0;
};

// Statistics of the tile (x, y) of 'level', computed from the pixels.
Statistics TileOf(const cv::Mat& image, int level, int x, int y) {
  if (level == 0) {
    const int gray = image.at<std::uint8_t>(y, x);
    return {gray, gray, gray};
  }
  const Statistics a = TileOf(image, level - 1, 2 * x, 2 * y);
  const Statistics b = TileOf(image, level - 1, 2 * x + 1, 2 * y);
  const Statistics c = TileOf(image, level - 1, 2 * x, 2 * y + 1);
  const Statistics d = TileOf(image, level - 1, 2 * x + 1, 2 * y + 1);
  return {std::min({a.minimum, b.minimum, c.minimum, d.minimum}),
          std::max({a.maximum, b.maximum, c.maximum, d.maximum}),
          ((a.mean + c.mean + 1) / 2 + (b.mean + d.mean + 1) / 2) / 2};
}

// Statistics over the 3 x 3 tiles around (x, y). The border is repeated.
Statistics BoxOf(const TileImage& tiles, int x, int y) {
  Statistics box;
  int sum = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int at = std::clamp(y + dy, 0, tiles.rows - 1) * tiles.columns +
                     std::clamp(x + dx, 0, tiles.columns - 1);
      box.minimum = std::min<int>(box.minimum, tiles.minimum[at]);
      box.maximum = std::max<int>(box.maximum, tiles.maximum[at]);
      sum += tiles.mean[at];
    }
  }
  box.mean = sum / 9;
  return box;
}

enum Decision { kDark, kBright, kNeither };

// Decides one pixel of the image at 'image_level' as the header specifies.
Decision Decide(const TilePyramid& pyramid, int gray, int image_level, int tile_level, int x, int y,
                int min_contrast) {
  const int tile_px = 1 << (tile_level - image_level);
  for (const int coarser : {0, 2}) {
    const TileImage& tiles = pyramid.level(tile_level + coarser);
    const TileImage& fine = pyramid.level(tile_level);
    if (tiles.columns == 0) continue;
    // The last whole tile applies to the pixels right of it and below.
    const int fine_x = std::min(x / tile_px, fine.columns - 1);
    const int fine_y = std::min(y / tile_px, fine.rows - 1);
    const Statistics box = BoxOf(tiles, std::min(fine_x >> coarser, tiles.columns - 1),
                                 std::min(fine_y >> coarser, tiles.rows - 1));
    const int contrast = box.maximum - box.minimum;
    if (contrast < min_contrast) continue;
    if (gray < std::max(0, box.mean - contrast / 16 - 1)) return kDark;
    return gray > (box.mean + box.maximum) / 2 ? kBright : kNeither;
  }
  return kNeither;
}

void ExpectBinarizedAsDefined(const cv::Mat& image, int image_level, int tile_level,
                              int min_contrast) {
  TilePyramid pyramid;
  pyramid.Build(image);
  const cv::Mat scaled = pyramid.ImageAt(image_level);
  if (scaled.empty()) return;
  LocalThreshold threshold;
  threshold.Measure(pyramid, image_level, tile_level);
  BinaryImage binary;
  threshold.Binarize(scaled, min_contrast, &binary);
  const TileImage& fine = pyramid.level(tile_level);
  const bool has_tiles = fine.columns > 0;
  int wrong = 0;
  for (int y = -1; y <= scaled.rows; ++y) {
    for (int x = -1; x <= scaled.cols; ++x) {
      const bool inside = x >= 0 && y >= 0 && x < scaled.cols && y < scaled.rows;
      const Decision expected = inside && has_tiles
                                    ? Decide(pyramid, scaled.at<std::uint8_t>(y, x), image_level,
                                             tile_level, x, y, min_contrast)
                                    : kNeither;
      wrong += binary.dark.at(x, y) != (expected == kDark);
      wrong += binary.bright.at(x, y) != (expected == kBright);
    }
  }
  EXPECT_EQ(wrong, 0) << image.cols << "x" << image.rows << ", levels " << image_level << " and "
                      << tile_level << ", contrast " << min_contrast;
}

TEST(TilePyramid, HoldsStatisticsOfAllTiles) {
  ForEveryTarget([] {
    Random random(1);
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(2, 2), cv::Size(3, 200), cv::Size(131, 67),
                                cv::Size(259, 257), cv::Size(752, 33)}) {
      const ExactImage exact =
          RandomImage(size.width, size.height, size.width + random.Integer(0, 9), &random);
      TilePyramid pyramid;
      pyramid.Build(exact.image);
      for (int level = 1; level < TilePyramid::kLevels; ++level) {
        const TileImage& tiles = pyramid.level(level);
        const bool empty = size.width >> level == 0 || size.height >> level == 0;
        ASSERT_EQ(tiles.columns, empty ? 0 : size.width >> level);
        ASSERT_EQ(tiles.rows, empty ? 0 : size.height >> level);
        for (int y = 0; y < tiles.rows; ++y) {
          for (int x = 0; x < tiles.columns; ++x) {
            const Statistics expected = TileOf(exact.image, level, x, y);
            const int at = y * tiles.columns + x;
            ASSERT_EQ(tiles.minimum[at], expected.minimum);
            ASSERT_EQ(tiles.maximum[at], expected.maximum);
            ASSERT_EQ(tiles.mean[at], expected.mean);
          }
        }
      }
    }
  });
}

TEST(TilePyramid, MeansAreImageAtLowerResolution) {
  Random random(2);
  const ExactImage exact = RandomImage(97, 61, 100, &random);
  TilePyramid pyramid;
  pyramid.Build(exact.image);
  EXPECT_EQ(pyramid.ImageAt(0).data, exact.image.data);
  EXPECT_FALSE(pyramid.ImageAt(5).empty());
  for (int level = 1; level < TilePyramid::kLevels; ++level) {
    const cv::Mat scaled = pyramid.ImageAt(level);
    if (scaled.empty()) continue;
    ASSERT_EQ(scaled.size(), cv::Size(97 >> level, 61 >> level));
    EXPECT_EQ(scaled.data, pyramid.level(level).mean.data());
  }
}

TEST(TilePyramid, MeanIsUnbiased) {
  // Half of the pixels have one gray value, the other half the next.
  cv::Mat image(512, 512, CV_8UC1);
  Random random(3);
  for (int y = 0; y < 512; ++y) {
    for (int x = 0; x < 512; ++x) {
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(random.Integer(100, 101));
    }
  }
  TilePyramid pyramid;
  pyramid.Build(image);
  EXPECT_NEAR(cv::mean(pyramid.ImageAt(1))[0], 100.5, 0.1);
}

TEST(LocalThreshold, DecidesEveryPixelAsDefined) {
  ForEveryTarget([] {
    Random random(4);
    for (int trial = 0; trial < 40; ++trial) {
      const int width = random.Integer(1, 300);
      const int height = random.Integer(1, 150);
      const ExactImage exact = RandomImage(width, height, width + random.Integer(0, 40), &random);
      const int image_level = random.Integer(0, 2);
      ExpectBinarizedAsDefined(exact.image, image_level, image_level + random.Integer(1, 3),
                               random.Integer(1, 60));
    }
  });
}

TEST(LocalThreshold, WorksForEveryWidth) {
  Random random(5);
  for (int width = 1; width <= 130; ++width) {
    const ExactImage exact = RandomImage(width, 40, width, &random);
    ExpectBinarizedAsDefined(exact.image, 0, 1, 20);
    ExpectBinarizedAsDefined(exact.image, 0, 2, 20);
  }
}

TEST(LocalThreshold, WorksForOnePixel) {
  cv::Mat image(1, 1, CV_8UC1, cv::Scalar(7));
  TilePyramid pyramid;
  pyramid.Build(image);
  LocalThreshold threshold;
  threshold.Measure(pyramid, 0, 1);
  BinaryImage binary;
  threshold.Binarize(image, 1, &binary);
  EXPECT_FALSE(binary.dark.at(0, 0));
  EXPECT_FALSE(binary.bright.at(0, 0));
}

TEST(LocalThreshold, InsideOfBroadStrokeIsDark) {
  // A stroke of 10 px is wider than a box of 3 tiles of 2 px. Its middle has no contrast of its own
  // and needs the coarse box.
  cv::Mat image(64, 64, CV_8UC1, cv::Scalar(200));
  image.colRange(24, 34) = 40;
  TilePyramid pyramid;
  pyramid.Build(image);
  LocalThreshold threshold;
  threshold.Measure(pyramid, 0, 1);
  BinaryImage binary;
  threshold.Binarize(image, 30, &binary);
  for (int x = 0; x < 64; ++x) EXPECT_EQ(binary.dark.at(x, 32), x >= 24 && x < 34) << x;
}

TEST(LocalThreshold, MeasuresQuantileOfContrasts) {
  // The left half is flat, the right half has a contrast of 100; boxes between them contain both.
  cv::Mat image(128, 128, CV_8UC1, cv::Scalar(50));
  for (int y = 0; y < 128; ++y) {
    for (int x = 64; x < 128; ++x) image.at<std::uint8_t>(y, x) = (x + y) % 2 == 0 ? 50 : 150;
  }
  TilePyramid pyramid;
  pyramid.Build(image);
  LocalThreshold threshold;
  threshold.Measure(pyramid, 0, 2);
  EXPECT_EQ(threshold.ContrastQuantile(0.4), 0);
  EXPECT_EQ(threshold.ContrastQuantile(0.6), 100);
}

}  // namespace
}  // namespace kestrel
