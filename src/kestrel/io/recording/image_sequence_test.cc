// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/image_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const cv::Mat kSmall(2, 3, CV_8UC1, 9);

std::vector<std::string> NamesOf(FrameSource* source) {
  std::vector<std::string> names;
  for (Frame frame; source->Next(&frame);) names.push_back(frame.name);
  return names;
}

TEST(ImageSequence, FolderIsInNaturalOrderWithNamesBelowIt) {
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

TEST(ImageSequence, TimesAreAtTheNominalRate) {
  const TestFolder folder;
  const std::string a = WriteTestImage(folder, "a.png", kSmall);
  ImageSequence source = OpenImageFiles({a, a, a, a});
  std::vector<std::int64_t> times;
  for (Frame frame; source.Next(&frame);) times.push_back(ToNanoseconds(frame.time));
  EXPECT_THAT(times, ElementsAre(0, 33333333, 66666667, 100000000));
  EXPECT_NEAR(source.rate_hz(), kNominalRateHz, 1e-6);
}

TEST(ImageSequence, EmptyFolderIsRefused) {
  const TestFolder folder;
  EXPECT_THAT(InputErrorOf([&] { OpenImageFolder(folder.path()); }),
              HasSubstr(folder.path() + ": no image"));
}

}  // namespace
}  // namespace kestrel
