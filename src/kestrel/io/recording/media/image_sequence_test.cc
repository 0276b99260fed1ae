// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/image_sequence.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const cv::Mat kSmall(2, 3, CV_8UC1, 9);

std::vector<std::string> NamesOf(FrameSource* source) {
  std::vector<std::string> names;
  for (Frame frame; source->Next(&frame);) names.push_back(frame.name);
  return names;
}

TEST(ImageSequence, SortsFolderNaturallyWithRelativeNames) {
  const TestFolder folder;
  for (const char* name : {"f10.png", "f9.png", "f010.jpg", "b/2.png", "b/10.png", "F1.PNG"}) {
    WriteTestImage(folder, name, kSmall);
  }
  folder.Write("notes.txt", "not an image");
  ImageSequence source = OpenImageFolder(folder.path());
  EXPECT_EQ(source.frame_count(), 6u);
  EXPECT_THAT(NamesOf(&source),
              ElementsAre("F1.PNG", "b/2.png", "b/10.png", "f9.png", "f010.jpg", "f10.png"));
}

TEST(ImageSequence, FilesKeepOrderAndNamesAsGiven) {
  const TestFolder folder;
  const std::string a = WriteTestImage(folder, "a.png", kSmall);
  const std::string b = WriteTestImage(folder, "b.png", kSmall);
  ImageSequence source = OpenImageFiles({b, a});
  EXPECT_THAT(NamesOf(&source), ElementsAre(b, a));
}

TEST(ImageSequence, TimesFollowNominalRate) {
  const TestFolder folder;
  const std::string a = WriteTestImage(folder, "a.png", kSmall);
  ImageSequence source = OpenImageFiles({a, a, a, a});
  std::vector<std::int64_t> times;
  for (Frame frame; source.Next(&frame);) times.push_back(ToNanoseconds(frame.time));
  EXPECT_THAT(times, ElementsAre(0, 33333333, 66666667, 100000000));
  EXPECT_NEAR(source.rate_hz(), kNominalRateHz, 1e-6);
}

TEST(ImageSequence, RefusesEmptyFolder) {
  const TestFolder folder;
  EXPECT_THAT(InputErrorOf([&] { OpenImageFolder(folder.path()); }),
              HasSubstr(folder.path() + ": no image"));
}

TEST(ImageSequence, SkipsBrokenImagesAnywhere) {
  const TestFolder folder;
  for (const char* name : {"1.png", "2.png", "3.png", "4.png"}) {
    WriteTestImage(folder, name, kSmall);
  }
  folder.Write("1.png", "");
  TestFolder::CutOff(folder / "3.png", 0.5);
  ImageSequence images = OpenImageFolder(folder.path());
  std::vector<std::string> broken;
  images.set_on_broken([&](const BrokenImage& image) { broken.push_back(image.name); });
  std::vector<std::string> names;
  for (Frame frame; images.Next(&frame);) names.push_back(frame.name);
  EXPECT_THAT(names, ElementsAre("2.png", "4.png"));
  EXPECT_THAT(broken, ElementsAre("1.png", "3.png"));
  EXPECT_EQ(images.left_out(), 2u);
}

TEST(ImageSequence, RefusesSourceWithoutGoodImage) {
  const TestFolder folder;
  folder.Write("1.png", "none");
  folder.Write("2.png", "none");
  Frame frame;
  EXPECT_THAT(InputErrorOf([&] { OpenImageFolder(folder.path()).Next(&frame); }),
              HasSubstr("none of 2 images can be read; the first: " + (folder / "1.png")));
  EXPECT_THAT(InputErrorOf([&] { OpenImageFiles({folder / "2.png"}).Next(&frame); }),
              StartsWith(folder / "2.png"));
}

TEST(ImageSequence, IgnoresHiddenFilesAndFolders) {
  const TestFolder folder;
  for (const char* name :
       {"a.png", "._a.png", ".thumbnails/b.png", "__MACOSX/c.png", "sub/d.png"}) {
    WriteTestImage(folder, name, kSmall);
  }
  ImageSequence images = OpenImageFolder(folder.path());
  EXPECT_THAT(NamesOf(&images), ElementsAre("a.png", "sub/d.png"));
}

// A TIFF of two pages of gray pixels, each with one value.
std::string TwoPageTiff(int width, int height, const std::array<char, 2>& grays) {
  std::string bytes = "II*";
  const auto add = [&](std::uint32_t number, int size) {
    for (int i = 0; i < size; ++i) bytes += static_cast<char>(number >> (8 * i) & 0xff);
  };
  constexpr std::uint32_t kEntries = 9, kDirectory = 2 + 12 * kEntries + 4;
  const auto pixels = static_cast<std::uint32_t>(width * height);
  add(0, 1);
  add(8, 4);
  for (const char gray : grays) {
    const auto start = static_cast<std::uint32_t>(bytes.size());
    const std::uint32_t data = start + kDirectory;
    const std::array<std::array<std::uint32_t, 2>, kEntries> entries{
        {{256, static_cast<std::uint32_t>(width)},
         {257, static_cast<std::uint32_t>(height)},
         {258, 8},
         {259, 1},
         {262, 1},
         {273, data},
         {277, 1},
         {278, static_cast<std::uint32_t>(height)},
         {279, pixels}}};
    add(kEntries, 2);
    for (const auto& [tag, value] : entries) {
      add(tag, 2);
      add(4, 2);  // the type: 32 bits
      add(1, 4);
      add(value, 4);
    }
    add(gray == grays.back() ? 0 : data + pixels, 4);
    bytes.append(pixels, gray);
  }
  return bytes;
}

TEST(ImageSequence, ReadsPagesOfTiffAsImages) {
  const TestFolder folder;
  folder.Write("scan.tif", TwoPageTiff(8, 6, {10, 100}));
  folder.Write("single.TIFF", TwoPageTiff(8, 6, {50, 50}));
  ImageSequence images = OpenImageFolder(folder.path());
  EXPECT_EQ(images.frame_count(), 3u);
  std::vector<std::string> seen;
  for (Frame frame; images.Next(&frame);) {
    seen.push_back(frame.name + ": " + std::to_string(frame.image.at<std::uint8_t>(5, 7)));
  }
  EXPECT_THAT(seen, ElementsAre("scan.tif/000000: 10", "scan.tif/000001: 100", "single.TIFF: 50"));
}

}  // namespace
}  // namespace kestrel
