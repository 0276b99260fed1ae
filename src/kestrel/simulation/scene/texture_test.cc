// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/texture.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

cv::Mat Codes(std::initializer_list<double> reflectances) {
  cv::Mat codes(1, static_cast<int>(reflectances.size()), CV_8UC1);
  int u = 0;
  for (const double reflectance : reflectances) {
    codes.at<std::uint8_t>(0, u++) = CodeOfReflectance(reflectance);
  }
  return codes;
}

TEST(TextureTest, CodesKeepReflectancesWithinOnePercentOfWhite) {
  for (const double reflectance : {0.0, 0.01, 0.1, 0.5, 1.0}) {
    EXPECT_NEAR(kReflectanceOfCode[CodeOfReflectance(reflectance)], reflectance, 0.004);
  }
}

TEST(TextureTest, SamplesBetweenPixelCentres) {
  const Texture texture(Codes({0, 1}), 1);
  EXPECT_FLOAT_EQ(texture.Sample<1>(0.5f, 0.5f, 0)[0], 0);
  EXPECT_FLOAT_EQ(texture.Sample<1>(1.0f, 0.5f, 0)[0], 0.5f);
  EXPECT_FLOAT_EQ(texture.Sample<1>(1.5f, 0.5f, 0)[0], 1);
}

TEST(TextureTest, ExtendsBeyondEdgesAsRequested) {
  const cv::Mat codes = Codes({0, 1});
  const Texture clamped(codes, 1, Texture::Beyond::kClamp);
  const Texture repeated(codes, 1, Texture::Beyond::kRepeat);
  const Texture mirrored(codes, 1, Texture::Beyond::kMirror);
  EXPECT_FLOAT_EQ(clamped.Sample<1>(2.5f, 0.5f, 0)[0], 1);
  EXPECT_FLOAT_EQ(repeated.Sample<1>(2.5f, 0.5f, 0)[0], 0);
  EXPECT_FLOAT_EQ(mirrored.Sample<1>(2.5f, 0.5f, 0)[0], 1);
  EXPECT_FLOAT_EQ(mirrored.Sample<1>(-0.5f, 0.5f, 0)[0], 0);
  EXPECT_FLOAT_EQ(repeated.Sample<1>(-0.5f, 0.5f, 0)[0], 1);
}

TEST(TextureTest, LevelsAverageLightNotCodes) {
  const Texture texture(Codes({0, 1, 0, 1}), 1);
  EXPECT_EQ(texture.LevelOf(0.3f), 0);
  EXPECT_EQ(texture.LevelOf(2), 1);
  EXPECT_EQ(texture.LevelOf(1000), 2) << "the last";
  EXPECT_NEAR(texture.Sample<1>(1, 0.5f, 1)[0], 0.5, 0.004);
  EXPECT_NEAR(texture.Sample<1>(2, 0.5f, 2)[0], 0.5, 0.01);
}

TEST(TextureTest, ColourAndGrayCameraSeeSamePaint) {
  const cv::Mat codes(2, 2, CV_8UC3, cv::Scalar(10, 100, 200));
  const Light<3> color = Texture(codes, 3).Sample<3>(1, 1, 0);
  EXPECT_FLOAT_EQ(color[2], kReflectanceOfCode[200]);
  const float gray = Texture(codes, 1).Sample<1>(1, 1, 0)[0];
  EXPECT_GT(gray, color[0]);
  EXPECT_LT(gray, color[2]);
}

}  // namespace
}  // namespace kestrel
