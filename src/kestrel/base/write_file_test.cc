// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/base/write_file.h"

#include <filesystem>
#include <string>
#include <unistd.h>

#include <gtest/gtest.h>

#include "kestrel/base/error.h"
#include "kestrel/base/read_file.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

class WriteFileTest : public ::testing::Test {
 protected:
  WriteFileTest()
      : folder_(fs::temp_directory_path() / ("kestrel_write_file_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~WriteFileTest() override { fs::remove_all(folder_); }

  std::string Path(const char* name) const { return (folder_ / name).string(); }
  std::ptrdiff_t FileCount() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  fs::path folder_;
};

TEST_F(WriteFileTest, ReplacesTheFileAndLeavesNothingElse) {
  WriteFile(Path("a"), "a longer first text");
  const std::string bytes("x\0y\n", 4);
  WriteFile(Path("a"), bytes);
  EXPECT_EQ(ReadFile(Path("a")), bytes);
  EXPECT_EQ(FileCount(), 1);
}

TEST_F(WriteFileTest, WhatCannotBeWrittenIsSaid) {
  EXPECT_THROW(WriteFile(Path("missing/a"), "text"), InputError);
}

TEST_F(WriteFileTest, OldFileStaysWhenTheNewOneCannotTakeItsPlace) {
  fs::create_directories(folder_ / "a" / "b");  // no file takes the place of a folder
  EXPECT_THROW(WriteFile(Path("a"), "text"), InputError);
  EXPECT_TRUE(fs::is_directory(folder_ / "a" / "b"));
  EXPECT_EQ(FileCount(), 1);
}

}  // namespace
}  // namespace kestrel
