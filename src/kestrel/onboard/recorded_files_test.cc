// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/onboard/recorded_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/base/read_file.h"
#include "kestrel/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

TEST(RecordedFiles, RowsAreThereWhenTheyAreCommitted) {
  const TestFolder folder;
  RecordedFiles files(folder.path(), {{folder / "a.csv", "#a\n"}, {folder / "b.csv", "#b\n"}});
  files.Add(0, "1\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.csv"));
  EXPECT_EQ(files.Commit(), "");
  files.Add(0, "2\n3\n");
  EXPECT_EQ(ReadFile(folder / "a.csv"), "#a\n1\n");
  EXPECT_EQ(files.Commit(), "");
  EXPECT_EQ(ReadFile(folder / "a.csv"), "#a\n1\n2\n3\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "b.csv")) << "no row, no file";
}

TEST(RecordedFiles, AFullDiskIsToldAndHoldsUpNoOtherFile) {
  const TestFolder folder;
  RecordedFiles files(folder.path(), {{"/dev/full", ""}, {folder / "b.csv", "#b\n"}});
  files.Add(0, "1\n");
  files.Add(1, "2\n");
  EXPECT_THAT(files.Commit(), HasSubstr("/dev/full: cannot be written"));
  EXPECT_EQ(ReadFile(folder / "b.csv"), "#b\n2\n");
}

TEST(RecordedFiles, RowsWaitUntilThereIsRoom) {
  const TestFolder folder;
  const std::string path = folder / "later/a.csv";
  RecordedFiles files(folder.path(), {{path, "#a\n"}});
  files.Add(0, "1\n");
  EXPECT_NE(files.Commit(), "");
  files.Add(0, "2\n");
  std::filesystem::create_directories(folder / "later");
  EXPECT_EQ(files.Commit(), "");
  EXPECT_EQ(files.Commit(), "");
  EXPECT_EQ(ReadFile(path), "#a\n1\n2\n");
}

}  // namespace
}  // namespace kestrel
