// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/euroc/recorded_files.h"

#include <csignal>
#include <filesystem>
#include <sys/resource.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

TEST(RecordedFiles, WritesRowsOnCommit) {
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

TEST(RecordedFiles, ReportsUnwritableFileAndWritesOthers) {
  const TestFolder folder;
  RecordedFiles files(folder.path(), {{folder / "no/a.csv", ""}, {folder / "b.csv", "#b\n"}});
  files.Add(0, "1\n");
  files.Add(1, "2\n");
  EXPECT_THAT(files.Commit(), HasSubstr("no/a.csv: cannot be written"));
  EXPECT_EQ(ReadFile(folder / "b.csv"), "#b\n2\n");
}

// A limit on the size of files simulates a full disk.
TEST(RecordedFiles, LeavesNoPartOfRowOnFullDisk) {
  const TestFolder folder;
  RecordedFiles files(folder.path(), {{folder / "a.csv", "#a\n"}, {folder / "b.csv", "#b\n"}});
  files.Add(0, "1\n");
  EXPECT_EQ(files.Commit(), "");
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{8, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  files.Add(0, "22222222\n");
  files.Add(1, "33333333\n");
  const std::string failure = files.Commit();
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(failure, HasSubstr("a.csv: cannot be written"));
  EXPECT_EQ(ReadFile(folder / "a.csv"), "#a\n1\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "b.csv"));
  EXPECT_EQ(files.Commit(), "");
  EXPECT_EQ(ReadFile(folder / "a.csv"), "#a\n1\n22222222\n");
  EXPECT_EQ(ReadFile(folder / "b.csv"), "#b\n33333333\n");
}

TEST(RecordedFiles, RowsWaitForRoomOnDisk) {
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
