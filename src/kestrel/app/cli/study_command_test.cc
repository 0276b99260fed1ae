// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <filesystem>
#include <string>

#include "kestrel/app/cli/test_command.h"

namespace kestrel {
namespace {

constexpr char kWhatToInstall[] = "kestrel study needs python3-kestrel and python3-distributed (";

class StudyCommandTest : public CommandTest {
 protected:
  // Only what 'folder' has is found as a program.
  void SetPath(const std::string& folder) const { setenv("PATH", folder.c_str(), 1); }
  ~StudyCommandTest() override { setenv("PATH", path_.c_str(), 1); }

 private:
  const std::string path_ = std::getenv("PATH");
};

TEST_F(StudyCommandTest, ReportsPackagesToInstallWithoutPython) {
  SetPath(folder_ / "nothing");
  ExpectInputError("study run study.yaml", kWhatToInstall);
}

TEST_F(StudyCommandTest, ReportsPackagesToInstallWithoutModules) {
  const std::string python =
      folder_.Write("python3", "#!/bin/sh\nexec /usr/bin/python3 -I -S \"$@\"\n");
  std::filesystem::permissions(python, std::filesystem::perms::owner_all);
  SetPath(std::filesystem::path(python).parent_path());
  ExpectInputError("study run study.yaml", kWhatToInstall);
}

TEST_F(StudyCommandTest, HelpNeedsNoPython) {
  SetPath(folder_ / "nothing");
  EXPECT_THAT(Succeed("study --help").out, ::testing::HasSubstr("study run STUDY.yaml"));
}

}  // namespace
}  // namespace kestrel
