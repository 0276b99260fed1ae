// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

TEST(OutputFolder, CreatesFoldersAndFiles) {
  const TestFolder folder;
  const OutputFolder output(folder / "a/b", false);
  output.OpenText("c/d.csv") << "text";
  EXPECT_EQ(ReadFile(folder / "a/b/c/d.csv"), "text");
}

TEST(OutputFolder, ReplacesOnRequestOnly) {
  const TestFolder folder;
  folder.Write("d.csv", "old");
  EXPECT_THAT(InputErrorOf([&] { OutputFolder(folder.path(), false).OpenText("d.csv"); }),
              HasSubstr("d.csv: exists already"));
  EXPECT_EQ(ReadFile(folder / "d.csv"), "old");
  OutputFolder(folder.path(), true).OpenText("d.csv") << "new";
  EXPECT_EQ(ReadFile(folder / "d.csv"), "new");
}

TEST(OutputFolder, RefusesNamesOutsideFolder) {
  const TestFolder folder;
  const OutputFolder output(folder / "out", false);
  EXPECT_EQ(output.NewFile("/a/../../b.png").string(), folder / "out/a/b.png");
}

TEST(OutputFolder, ReportsFolderThatCannotBeCreated) {
  const TestFolder folder;
  const std::string file = folder.Write("file", "");
  EXPECT_THAT(InputErrorOf([&] { OutputFolder(file + "/out", false); }), HasSubstr(file + "/out"));
  EXPECT_THAT(InputErrorOf([&] { OutputFolder(file, false); }), HasSubstr("file"));
}

TEST(OutputFolder, ReportsUnwritableFile) {
  const TestFolder folder;
  std::filesystem::create_directories(folder / "out/d.csv");
  EXPECT_THAT(InputErrorOf([&] { OutputFolder(folder / "out", true).OpenText("d.csv"); }),
              HasSubstr("d.csv: cannot be written"));
}

}  // namespace
}  // namespace kestrel
