// SPDX-License-Identifier: BSD-3-Clause
// The images in KESTREL_IMAGES_DIR were written by other encoders (OpenCV's, and bytes by hand).
// Most of them contain ValueAt(). Those of a photograph have OpenCV's decoding beside them.
#include "kestrel/core/codec/image_codec.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/core/codec/jpeg_codec.h"
#include "kestrel/core/codec/png_codec.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr int kWidth = 24, kHeight = 18;

std::string PathOf(const std::string& name) { return KESTREL_IMAGES_DIR "/" + name; }
cv::Mat Read(const std::string& name) { return ReadImage(PathOf(name)); }

int ValueAt(int u, int v, int channel) { return (7 * u + 13 * v + 61 * channel) % 256; }

cv::Mat Expected(int type) {
  cv::Mat image(kHeight, kWidth, type);
  const int channels = image.channels();
  for (int v = 0; v < kHeight; ++v) {
    for (int i = 0; i < kWidth * channels; ++i) {
      const int u = i / channels;
      const int value = ValueAt(u, v, i % channels);
      if (image.depth() == CV_8U) {
        image.ptr<std::uint8_t>(v)[i] = static_cast<std::uint8_t>(value);
      } else {
        image.ptr<std::uint16_t>(v)[i] = static_cast<std::uint16_t>(257 * value + 3 * u);
      }
    }
  }
  return image;
}

// The colour of index (u + v) mod 16 in the palettes; BGRA.
cv::Vec4b PaletteColor(int u, int v) {
  const int i = (u + v) % 16;
  return {static_cast<std::uint8_t>(5 * i), static_cast<std::uint8_t>(255 - 16 * i),
          static_cast<std::uint8_t>(16 * i), static_cast<std::uint8_t>(17 * i)};
}

void ExpectSame(const cv::Mat& image, const cv::Mat& expected) {
  ASSERT_EQ(image.type(), expected.type());
  ASSERT_EQ(image.size(), expected.size());
  EXPECT_EQ(cv::norm(image, expected, cv::NORM_INF), 0);
}

void ExpectPalette(const std::string& name, int channels) {
  const cv::Mat image = Read(name);
  ASSERT_EQ(image.type(), CV_8UC(channels)) << name;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      for (int k = 0; k < channels; ++k) {
        ASSERT_EQ(image.ptr(v)[channels * u + k], PaletteColor(u, v)[k]) << name << u << " " << v;
      }
    }
  }
}

cv::Mat Noise(int width, int height, int type, int seed = 1) {
  cv::Mat image(height, width, type);
  cv::RNG random(seed);
  random.fill(image, cv::RNG::UNIFORM, 0, image.depth() == CV_8U ? 256 : 65536);
  return image;
}

TEST(DecodeImage, ReadsLosslessFormatsExactly) {
  const std::pair<const char*, int> kImages[] = {
      {"gray.png", CV_8UC1},       {"bgr.png", CV_8UC3},     {"bgra.png", CV_8UC4},
      {"gray16.png", CV_16UC1},    {"bgr16.png", CV_16UC3},  {"bgra16.png", CV_16UC4},
      {"interlaced.png", CV_8UC1}, {"gamma.png", CV_8UC1},   {"gray_transparent.png", CV_8UC1},
      {"gray.tif", CV_8UC1},       {"bgr.tif", CV_8UC3},     {"gray.bmp", CV_8UC1},
      {"bgr.bmp", CV_8UC3},        {"bgra.bmp", CV_8UC3},    {"gray.pgm", CV_8UC1},
      {"bgr.ppm", CV_8UC3},        {"gray16.pgm", CV_16UC1}, {"text.pgm", CV_8UC1},
      {"text.ppm", CV_8UC3},       {"bgr.webp", CV_8UC3}};
  for (const auto& [name, type] : kImages) {
    SCOPED_TRACE(name);
    ExpectSame(Read(name), Expected(type));
  }
}

TEST(DecodeImage, ConvertsPalettesToColors) {
  ExpectPalette("palette.png", 3);
  ExpectPalette("palette_alpha.png", 4);
  ExpectPalette("palette.bmp", 3);
}

TEST(DecodeImage, ConvertsLowBitDepthsToEight) {
  for (const int bits : {1, 2, 4}) {
    const cv::Mat image = Read("gray_" + std::to_string(bits) + "_bits.png");
    ASSERT_EQ(image.type(), CV_8UC1);
    const int levels = 1 << bits;
    for (int u = 0; u < kWidth; ++u) {
      EXPECT_EQ(image.at<std::uint8_t>(3, u), (u + 3) % levels * 255 / (levels - 1)) << bits;
    }
  }
}

TEST(DecodeImage, KeepsAlphaOfGrayAndTransparentColor) {
  const cv::Mat gray = Read("gray_alpha.png");
  ASSERT_EQ(gray.type(), CV_8UC4);
  const int value = ValueAt(5, 4, 0);
  EXPECT_EQ(gray.at<cv::Vec4b>(4, 5), cv::Vec4b(value, value, value, ValueAt(5, 4, 3)));
  const cv::Mat color = Read("bgr_transparent.png");
  ASSERT_EQ(color.type(), CV_8UC4);
  EXPECT_EQ(color.at<cv::Vec4b>(0, 0), cv::Vec4b(0, 61, 122, 0)) << "the transparent colour";
  EXPECT_EQ(color.at<cv::Vec4b>(0, 1)[3], 255);
  const cv::Mat webp = Read("bgra.webp");
  ASSERT_EQ(webp.type(), CV_8UC4);
  const cv::Mat expected = Expected(CV_8UC4);
  EXPECT_EQ(webp.at<cv::Vec4b>(4, 5), expected.at<cv::Vec4b>(4, 5));
}

TEST(DecodeImage, ReadsPhotographsLikeOpenCv) {
  for (const std::string name :
       {"photo.jpg", "photo_gray.jpg", "photo_progressive.jpg", "photo_lossy.webp"}) {
    const cv::Mat image = Read(name);
    const cv::Mat reference = Read(name + ".png");
    ASSERT_EQ(image.type(), reference.type()) << name;
    EXPECT_LE(cv::norm(image, reference, cv::NORM_INF), 1) << name;
  }
}

TEST(DecodeImage, RefusesTruncatedFiles) {
  for (const auto& entry : std::filesystem::directory_iterator(KESTREL_IMAGES_DIR)) {
    const std::string bytes = ReadFile(entry.path().string());
    for (const double part : {0.0, 0.02, 0.1, 0.5, 0.9}) {
      const auto size = static_cast<std::size_t>(part * static_cast<double>(bytes.size()));
      EXPECT_THAT(InputErrorOf([&] { DecodeImage(bytes.substr(0, size), "a.x"); }),
                  StartsWith("a.x: "))
          << entry.path() << " " << part;
    }
  }
}

// Corrupt files are either read or refused in one line, and the test ends.
TEST(DecodeImage, ReadsOrRefusesCorruptFiles) {
  cv::RNG random(7);
  for (const auto& entry : std::filesystem::directory_iterator(KESTREL_IMAGES_DIR)) {
    const std::string bytes = ReadFile(entry.path().string());
    for (int i = 0; i < 40; ++i) {
      std::string broken = bytes;
      const int at = random.uniform(0, static_cast<int>(bytes.size()));
      const int value = random.uniform(0, 256);
      broken[at] = static_cast<char>(value);
      const std::string error = InputErrorOf([&] { DecodeImage(broken, "a.x", 1 << 20); });
      EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
  }
}

TEST(DecodeImage, PrintsNothingToTerminal) {
  testing::internal::CaptureStderr();
  for (const char* name : {"gray.png", "photo.jpg", "gray.tif", "bgr.webp"}) {
    std::string bytes = ReadFile(PathOf(name));
    for (std::size_t i = 40; i < bytes.size(); i += 11) bytes[i] ^= 0x55;
    InputErrorOf([&] { DecodeImage(bytes, "a.x"); });
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(DecodeImage, NamesSupportedFormatsInError) {
  EXPECT_EQ(
      InputErrorOf([] { DecodeImage("GIF89a", "a.gif"); }),
      "a.gif: cannot be decoded as an image, expected PNG, JPEG, TIFF, WebP, BMP, PGM or PPM");
  EXPECT_EQ(InputErrorOf([] { Read("gray16.tif"); }),
            PathOf("gray16.tif") + ": is a 16-bit image, expected 8 bits a channel");
}

TEST(DecodeImage, RefusesLargeImagesBeforeAllocation) {
  const std::string png = ReadFile(PathOf("gray.png"));
  EXPECT_EQ(InputErrorOf([&] { DecodeImage(png, "a.png", kWidth * kHeight); }), "");
  EXPECT_THAT(InputErrorOf([&] { DecodeImage(png, "a.png", kWidth * kHeight - 1); }),
              HasSubstr("a.png: cannot be decoded as an image: it has 24 x 18 px, expected"));
  EXPECT_THAT(InputErrorOf([] { DecodeImage("P5 1000000 1000000 255 ", "a.pgm"); }),
              HasSubstr("1000000 x 1000000 px"));
}

TEST(EncodePng, RoundTripsExactly) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3, CV_16UC4}) {
    const cv::Mat image = Noise(37, 21, type);
    for (const int level : {kFastPng, 0, 1, 9}) {
      ExpectSame(DecodeImage(EncodePng(image, level), "image"), image);
    }
    const cv::Mat part = image(cv::Rect(3, 2, 20, 11));
    ExpectSame(DecodeImage(EncodePng(part), "image"), part);
  }
}

TEST(EncodePng, RefusesOtherTypes) {
  for (const int type : {CV_32FC1, CV_8UC2}) {
    EXPECT_THAT(InputErrorOf([&] { EncodePng(cv::Mat::zeros(4, 4, type)); }),
                HasSubstr("expected 8 or 16 bits"));
  }
  EXPECT_NE(InputErrorOf([] { EncodePng(cv::Mat()); }), "");
}

TEST(EncodeJpeg, IsCloseToImage) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    const cv::Mat image = Read(type == CV_8UC1 ? "photo_gray.jpg.png" : "photo.jpg.png");
    const cv::Mat read = DecodeImage(EncodeJpeg(image, 95), "image");
    ASSERT_EQ(read.type(), type);
    EXPECT_LT(cv::norm(read, image, cv::NORM_L1) / static_cast<double>(image.total()), 6);
  }
  EXPECT_NE(InputErrorOf([] { EncodeJpeg(cv::Mat(4, 4, CV_16UC1), 95); }), "");
}

TEST(JpegEncoder, AppendsSuccessiveImages) {
  JpegEncoder encoder(90);
  const cv::Mat large = Noise(64, 48, CV_8UC1, 1);
  const cv::Mat small = Noise(16, 16, CV_8UC3, 2);
  std::string bytes = "head";
  ASSERT_TRUE(encoder.Append(large, &bytes));
  const std::size_t first = bytes.size();
  ASSERT_TRUE(encoder.Append(small, &bytes));
  EXPECT_EQ(bytes.substr(4, first - 4), EncodeJpeg(large, 90));
  EXPECT_EQ(bytes.substr(first), EncodeJpeg(small, 90));
  EXPECT_FALSE(encoder.Append(cv::Mat(4, 4, CV_16UC1), &bytes));
}

TEST(WriteImage, ChoosesFormatByFileName) {
  const TestFolder folder;
  const cv::Mat image = Noise(31, 17, CV_8UC1);
  WriteImage(folder / "a.PNG", image);
  ExpectSame(ReadImage(folder / "a.PNG"), image);
  WriteImage(folder / "a.jpg", image);
  EXPECT_TRUE(IsJpeg(ReadFile(folder / "a.jpg")));
  EXPECT_THAT(InputErrorOf([&] { WriteImage(folder / "a.gif", image); }),
              HasSubstr("a.gif: cannot be written, expected"));
  EXPECT_THAT(InputErrorOf([&] { WriteImage(folder / "none/a.png", image); }),
              HasSubstr("none/a.png: cannot be written"));
}

}  // namespace
}  // namespace kestrel
