// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/even_sample.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

// The names of the images that are kept of a stream of 'count'.
std::vector<int> Kept(int count) {
  EvenSample sample;
  for (int i = 0; i < count; ++i) sample.Add(std::to_string(i), cv::Mat(1, 1, CV_8UC1));
  std::vector<int> kept;
  for (const LensImage& image : sample.Take()) kept.push_back(std::stoi(image.name));
  return kept;
}

TEST(EvenSample, KeepsAllImagesOfShortStream) {
  EXPECT_TRUE(Kept(0).empty());
  EXPECT_EQ(Kept(400).size(), 400u);
}

TEST(EvenSample, KeepsEvenlySpacedImagesOfLongStream) {
  for (const int count : {401, 1000, 12'345}) {
    const std::vector<int> kept = Kept(count);
    EXPECT_GT(kept.size(), 200u) << count;
    EXPECT_LE(kept.size(), 400u) << count;
    EXPECT_EQ(kept.front(), 0);
    const int stride = kept[1];
    for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(kept[i], static_cast<int>(i) * stride);
    EXPECT_LT(count - kept.back(), 2 * stride) << "reaches to the end";
  }
}

TEST(EvenSample, OwnsItsPixels) {
  EvenSample sample;
  cv::Mat image(1, 1, CV_8UC1, 7.0);
  sample.Add("a", image);
  image.setTo(9);
  EXPECT_EQ(sample.Take().front().image.at<unsigned char>(0), 7);
}

}  // namespace
}  // namespace kestrel
