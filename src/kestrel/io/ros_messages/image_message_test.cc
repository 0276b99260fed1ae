// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/image_message.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/codec/png_codec.h"
#include "kestrel/io/bags/test_bags.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

const cv::Vec3b kBlueish(200, 60, 20);  // in BGR

// An image of 8x6 pixels of one colour as a message in an encoding.
struct Coloured {
  std::string encoding;
  int channels;
  std::vector<int> bytes;  // bytes of two pixels in a row; for Bayer patterns of two rows
  int tolerance;
};

class EveryEncoding : public ::testing::TestWithParam<Coloured> {};

TEST_P(EveryEncoding, GivesColour) {
  const auto& [encoding, channels, bytes, tolerance] = GetParam();
  cv::Mat pixels(6, 8 * channels, CV_8UC1);
  const int period = 2 * channels;
  for (int y = 0; y < pixels.rows; ++y) {
    for (int x = 0; x < pixels.cols; ++x) {
      const bool has_second_row = bytes.size() > static_cast<std::size_t>(period);
      const int row = has_second_row ? y % 2 : 0;
      pixels.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(bytes[row * period + x % period]);
    }
  }
  ImageMessage message = BagImageMessage(pixels, Time(), encoding);
  message.width = 8;
  const cv::Vec3b bgr = DecodeImage(message, PixelFormat::kBgr, "image").at<cv::Vec3b>(3, 4);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(bgr[c], kBlueish[c], tolerance) << c;
  const int gray = DecodeImage(message, PixelFormat::kGray, "image").at<std::uint8_t>(3, 4);
  EXPECT_NEAR(gray, 0.114 * 200 + 0.587 * 60 + 0.299 * 20, 1 + 8 * (channels == 2));
}

INSTANTIATE_TEST_SUITE_P(
    Encodings, EveryEncoding,
    ::testing::Values(Coloured{"bgr8", 3, {200, 60, 20, 200, 60, 20}, 0},
                      Coloured{"rgb8", 3, {20, 60, 200, 20, 60, 200}, 0},
                      Coloured{"bgra8", 4, {200, 60, 20, 255, 200, 60, 20, 255}, 0},
                      Coloured{"rgba8", 4, {20, 60, 200, 255, 20, 60, 200, 255}, 0},
                      Coloured{"bayer_rggb8", 1, {20, 60, 60, 200}, 0},
                      Coloured{"bayer_bggr8", 1, {200, 60, 60, 20}, 0},
                      Coloured{"bayer_gbrg8", 1, {60, 200, 20, 60}, 0},
                      Coloured{"bayer_grbg8", 1, {60, 20, 200, 60}, 0},
                      // In BT.601: y = 71, u = 195, v = 100.
                      Coloured{"yuv422", 2, {195, 71, 100, 71}, 4},
                      Coloured{"yuv422_yuy2", 2, {71, 195, 71, 100}, 4}),
    [](const auto& coloured) { return coloured.param.encoding; });

TEST(DecodeImage, AcceptsPaddedRows) {
  const cv::Mat wide(4, 16, CV_8UC1, cv::Scalar(9));
  ImageMessage message = BagImageMessage(wide, Time());
  message.width = 10;
  const cv::Mat image = DecodeImage(message, PixelFormat::kGray, "image");
  EXPECT_EQ(image.size(), cv::Size(10, 4));
  EXPECT_EQ(cv::countNonZero(image != 9), 0);
}

TEST(DecodeImage, ReportsFaultyMessages) {
  const cv::Mat image(4, 16, CV_8UC1, cv::Scalar(9));
  const ImageMessage good = BagImageMessage(image, Time());
  const auto error_of = [](const ImageMessage& message) {
    return InputErrorOf([&] { DecodeImage(message, PixelFormat::kGray, "f.bag: a/1"); });
  };
  ImageMessage message = good;
  message.encoding = "mono16";
  EXPECT_THAT(error_of(message), HasSubstr("f.bag: a/1: has the encoding 'mono16', expected 8"));
  message = good;
  message.height = 5;
  EXPECT_THAT(error_of(message), HasSubstr("too few for 16x5"));
  message = good;
  message.step = 15;
  EXPECT_THAT(error_of(message), HasSubstr("rows of 15, too few"));
  message = good;
  message.width = 0xffffffff;
  EXPECT_THAT(error_of(message), HasSubstr("expected 1 to 32768"));
  message = good;
  message.encoding = "yuv422";
  message.width = 7;
  EXPECT_THAT(error_of(message), HasSubstr("even number"));
}

TEST(DecodeImage, ReadsCompressedImages) {
  const cv::Mat image = NoiseImage(40, 30, CV_8UC3);
  const std::string png = EncodePng(image);
  CompressedImageMessage message;
  message.format = "bgr8; png compressed bgr8";
  message.data = png;
  EXPECT_EQ(cv::norm(DecodeImage(message, PixelFormat::kBgr, "image"), image, cv::NORM_INF), 0);
  message.data = message.data.substr(0, 500);
  EXPECT_THAT(InputErrorOf([&] { DecodeImage(message, PixelFormat::kBgr, "image"); }),
              HasSubstr("image: the image file is cut off"));
  message.format = "16UC1; compressedDepth";
  EXPECT_THAT(InputErrorOf([&] { DecodeImage(message, PixelFormat::kBgr, "image"); }),
              HasSubstr("depth"));
}

}  // namespace
}  // namespace kestrel
