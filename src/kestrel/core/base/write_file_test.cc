// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/write_file.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

class WriteFileTest : public ::testing::Test {
 protected:
  std::string Path(const char* name) const { return (folder_ / name).string(); }
  std::ptrdiff_t FileCount() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  const TestFolder test_folder_;
  const fs::path folder_ = test_folder_.path();
};

TEST_F(WriteFileTest, ReplacesFileAndLeavesNoOther) {
  WriteFile(Path("a"), "a longer first text");
  const std::string bytes("x\0y\n", 4);
  WriteFile(Path("a"), bytes);
  EXPECT_EQ(ReadFile(Path("a")), bytes);
  EXPECT_EQ(FileCount(), 1);
}

TEST_F(WriteFileTest, ReplacesFileWithoutSync) {
  ReplaceFile(Path("a"), "old");
  ReplaceFile(Path("a"), "new");
  EXPECT_EQ(ReadFile(Path("a")), "new");
  EXPECT_EQ(FileCount(), 1);
  EXPECT_THROW(ReplaceFile(Path("missing/a"), "text"), InputError);
}

TEST_F(WriteFileTest, ReportsUnwritablePath) {
  EXPECT_THROW(WriteFile(Path("missing/a"), "text"), InputError);
}

TEST_F(WriteFileTest, KeepsOldFileWhenReplacementFails) {
  fs::create_directories(folder_ / "a" / "b");  // a file cannot replace a folder
  EXPECT_THROW(WriteFile(Path("a"), "text"), InputError);
  EXPECT_TRUE(fs::is_directory(folder_ / "a" / "b"));
  EXPECT_EQ(FileCount(), 1);
}

}  // namespace
}  // namespace kestrel
