// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/taken_marks.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

TEST(TakenMarksTest, ObjectIsTakenOnceByAllThatShareTheFile) {
  const TestFolder folder;
  const std::string file = folder / "taken";
  TakenMarks one(file, 3), other(file, 3), alone("", 3);
  EXPECT_TRUE(one.Take(1));
  EXPECT_FALSE(other.Take(1));
  EXPECT_TRUE(other[1]);
  EXPECT_FALSE(other[0]);
  EXPECT_FALSE(alone[1]);
}

TEST(TakenMarksTest, FileOfSomethingElseIsRefusedAndKept) {
  const TestFolder folder;
  const std::string file = folder / "flight.csv";
  std::ofstream(file) << "time,x,y\n";
  EXPECT_THROW(TakenMarks(file, 3), InputError);
  EXPECT_EQ(std::filesystem::file_size(file), 9);
}

TEST(TakenMarksTest, FileThatCannotBeUsedIsRefused) {
  EXPECT_THROW(TakenMarks("/nowhere/taken", 3), InputError);
}

}  // namespace
}  // namespace kestrel
