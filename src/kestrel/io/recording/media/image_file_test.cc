// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/image_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/read_file.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

TEST(ReadGrayImage, ReadsGrayUnchanged) {
  const TestFolder folder;
  const cv::Mat image = NoiseImage(31, 17, CV_8UC1);
  const cv::Mat read = ReadGrayImage(WriteTestImage(folder, "a.png", image));
  EXPECT_EQ(cv::norm(image, read, cv::NORM_INF), 0);
}

TEST(ReadGrayImage, ConvertsColourToLuminance) {
  const TestFolder folder;
  const cv::Mat bgr(4, 4, CV_8UC3, cv::Scalar(10, 200, 90));
  const cv::Mat bgra(4, 4, CV_8UC4, cv::Scalar(10, 200, 90, 128));
  for (const cv::Mat& image : {bgr, bgra}) {
    const cv::Mat gray = ReadGrayImage(WriteTestImage(folder, "a.png", image));
    ASSERT_EQ(gray.type(), CV_8UC1);
    EXPECT_NEAR(gray.at<std::uint8_t>(2, 2), 0.114 * 10 + 0.587 * 200 + 0.299 * 90, 1);
  }
}

TEST(ReadGrayImage, RefusesSixteenBits) {
  const TestFolder folder;
  const std::string file = WriteTestImage(folder, "deep.png", cv::Mat(4, 4, CV_16UC1, 1000));
  EXPECT_THAT(InputErrorOf([&] { ReadGrayImage(file); }), HasSubstr(file + ": is a 16-bit image"));
}

TEST(ReadGrayImage, RefusesFilesTruncatedAnywhere) {
  const TestFolder folder;
  for (const char* name : {"a.png", "a.jpg"}) {
    for (const double part : {0.01, 0.3, 0.6, 0.9, 0.99, 0.9999}) {
      const std::string file = WriteTestImage(folder, name, NoiseImage(120, 90, CV_8UC1));
      TestFolder::CutOff(file, part);
      EXPECT_THAT(InputErrorOf([&] { ReadGrayImage(file); }), HasSubstr(file)) << part;
    }
  }
}

TEST(ReadGrayImage, RefusesTruncatedJpegWithThumbnail) {
  const TestFolder folder;
  const std::string jpeg = ReadFile(WriteTestImage(folder, "a.jpg", NoiseImage(64, 48, CV_8UC1)));
  const std::string thumbnail =
      ReadFile(WriteTestImage(folder, "t.jpg", NoiseImage(8, 8, CV_8UC1)));
  const std::size_t length = thumbnail.size() + 2;
  const std::string segment = std::string("\xff\xe1") + static_cast<char>(length >> 8) +
                              static_cast<char>(length & 0xff) + thumbnail;
  const std::string whole = jpeg.substr(0, 2) + segment + jpeg.substr(2);
  EXPECT_EQ(InputErrorOf([&] { ReadGrayImage(folder.Write("w.jpg", whole)); }), "");
  const std::string cut = whole.substr(0, whole.size() * 3 / 4);
  EXPECT_NE(InputErrorOf([&] { ReadGrayImage(folder.Write("c.jpg", cut)); }), "");
}

TEST(ReadGrayImage, AcceptsTrailingBytes) {
  const TestFolder folder;
  for (const char* name : {"a.png", "a.jpg"}) {
    const std::string bytes = ReadFile(WriteTestImage(folder, name, NoiseImage(20, 20, CV_8UC1)));
    const std::string file = folder.Write(name, bytes + "appended by the camera");
    EXPECT_EQ(ReadGrayImage(file).cols, 20) << name;
  }
}

TEST(ReadGrayImage, RefusesNonImages) {
  const TestFolder folder;
  EXPECT_THAT(InputErrorOf([&] { ReadGrayImage(folder / "none.png"); }), HasSubstr("no such file"));
  EXPECT_THAT(InputErrorOf([&] { ReadGrayImage(folder.path()); }), HasSubstr("is a folder"));
  for (const char* text : {"", "hello", "\x89PNG\r\n\x1a\n"}) {
    const std::string file = folder.Write("bad.png", text);
    EXPECT_THAT(InputErrorOf([&] { ReadGrayImage(file); }), HasSubstr(file)) << text;
  }
}

TEST(ReadGrayImage, ReadsOnePixelAndVeryWideImages) {
  const TestFolder folder;
  EXPECT_EQ(ReadGrayImage(WriteTestImage(folder, "1.png", cv::Mat(1, 1, CV_8UC1, 7))).size(),
            cv::Size(1, 1));
  EXPECT_EQ(ReadGrayImage(WriteTestImage(folder, "w.png", cv::Mat(3, 20000, CV_8UC1, 7))).cols,
            20000);
}

}  // namespace
}  // namespace kestrel
