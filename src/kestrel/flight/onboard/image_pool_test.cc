// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/image_pool.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(ImagePool, GivesOutUnusedImagesOnly) {
  ImagePool pool(2);
  cv::Mat first = pool.Take({8, 4}, CV_8UC1);
  const cv::Mat second = pool.Take({8, 4}, CV_8UC1);
  const cv::Mat third = pool.Take({8, 4}, CV_8UC1);
  EXPECT_NE(first.data, second.data);
  EXPECT_NE(first.data, third.data);
  EXPECT_NE(second.data, third.data);
  const uchar* memory = first.data;
  const cv::Mat other_user = first;
  first.release();
  EXPECT_NE(pool.Take({8, 4}, CV_8UC1).data, memory);
}

TEST(ImagePool, ReusesMemory) {
  ImagePool pool(2);
  const uchar* memory = pool.Take({8, 4}, CV_8UC1).data;
  EXPECT_EQ(pool.Take({8, 4}, CV_8UC1).data, memory);
  const cv::Mat larger = pool.Take({16, 4}, CV_8UC3);
  EXPECT_EQ(larger.size(), cv::Size(16, 4));
  EXPECT_EQ(larger.type(), CV_8UC3);
}

}  // namespace
}  // namespace kestrel
