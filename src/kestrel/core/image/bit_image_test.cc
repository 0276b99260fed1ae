// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/bit_image.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(BitImage, IsClearAroundImage) {
  BitImage image;
  for (const int width : {1, 63, 64, 65, 128}) {
    image.Reset(width, 3);
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < width; ++x) image.Set(x, y);
    }
    for (int y = -1; y <= 3; ++y) {
      for (int x = -1; x <= width; ++x) {
        EXPECT_EQ(image.at(x, y), x >= 0 && x < width && y >= 0 && y < 3) << x << ", " << y;
      }
    }
  }
}

TEST(BitImage, ResetClears) {
  BitImage image;
  image.Reset(200, 100);
  for (int i = 0; i < 100; ++i) image.Set(2 * i, i);
  image.Reset(70, 30);
  for (int y = -1; y <= 30; ++y) {
    for (int x = -1; x <= 70; ++x) ASSERT_FALSE(image.at(x, y));
  }
}

TEST(InvertBits, LeavesSurroundingsClear) {
  for (const int width : {1, 63, 64, 65, 130}) {
    BitImage image, inverse;
    image.Reset(width, 3);
    for (int x = 0; x < width; x += 3) image.Set(x, 1);
    InvertBits(image, &inverse);
    for (int y = -1; y <= 3; ++y) {
      for (int x = -1; x <= width; ++x) {
        const bool outside = x < 0 || y < 0 || x >= width || y >= 3;
        ASSERT_EQ(inverse.at(x, y), !outside && !image.at(x, y))
            << "width " << width << " at " << x << ", " << y;
      }
    }
  }
}

}  // namespace
}  // namespace kestrel
