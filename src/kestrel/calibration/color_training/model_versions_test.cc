// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/color_training/model_versions.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/core/base/write_file.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

class ModelVersionsTest : public ::testing::Test {
 protected:
  const TestFolder folder_;
  const std::string path_ = folder_ / "objects.yaml";
};

TEST_F(ModelVersionsTest, CopiesFileBeforeOverwriting) {
  ObjectModel model = DefaultObjectModel();
  EXPECT_EQ(SaveModelVersion(path_, model), "");
  const std::string first = ReadFile(path_);
  EXPECT_EQ(SaveModelVersion(path_, model), "") << "the same again";
  model.colors.colors[0].components[0].correlation = 0.25;
  EXPECT_EQ(SaveModelVersion(path_, model), path_ + ".1");
  EXPECT_EQ(ReadFile(path_ + ".1"), first);
  EXPECT_EQ(ReadObjectModel(path_).colors.colors[0].components[0].correlation, 0.25);
  model.colors.max_distance = 2.5;
  EXPECT_EQ(SaveModelVersion(path_, model), path_ + ".2");
  EXPECT_EQ(ReadFile(path_ + ".1"), first);
}

TEST_F(ModelVersionsTest, CopiesFileThatIsNoModel) {
  WriteFile(path_, "notes\n");
  EXPECT_EQ(SaveModelVersion(path_, DefaultObjectModel()), path_ + ".1");
  EXPECT_EQ(ReadFile(path_ + ".1"), "notes\n");
}

TEST_F(ModelVersionsTest, DoesNotWriteUnreadableModel) {
  ObjectModel model = DefaultObjectModel();
  SaveModelVersion(path_, model);
  const std::string before = ReadFile(path_);
  model.colors.colors[0].components[0].sigma.value = 0;
  EXPECT_THROW(SaveModelVersion(path_, model), InputError);
  EXPECT_EQ(ReadFile(path_), before);
  EXPECT_FALSE(fs::exists(path_ + ".1"));
  EXPECT_THROW(SaveModelVersion(folder_ / "none/objects.yaml", DefaultObjectModel()), InputError);
}

TEST(LineDifference, NamesColourOfDifferentLines) {
  const std::string before = "colors:\n - name: red\n  a\n  b\n - name: blue\n  c\n";
  const std::string after = "colors:\n - name: red\n  a\n  b\n - name: blue\n  d\n  e\n";
  EXPECT_EQ(LineDifference(before, after),
            (std::vector<std::string>{"   - name: blue", "-   c", "+   d", "+   e"}));
  EXPECT_TRUE(LineDifference(before, before).empty());
  EXPECT_EQ(LineDifference("", "a\n"), std::vector<std::string>{"+ a"});
}

}  // namespace
}  // namespace kestrel
