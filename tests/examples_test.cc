// SPDX-License-Identifier: BSD-3-Clause
// The files of examples/ match the command.
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "kestrel/app/cli/test_command.h"
#include "kestrel/app/options/kestrel_options.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

const std::string kExamples = KESTREL_EXAMPLES_DIR;

std::vector<std::string> ExampleConfigurations() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(kExamples)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path().string());
  }
  return files;
}

TEST(ExamplesTest, ConfigurationsAreReadable) {
  const std::vector<std::string> files = ExampleConfigurations();
  EXPECT_GE(files.size(), 3u);
  for (const std::string& file : files) {
    const KestrelOptions options = ReadKestrelOptions(file, {});
    EXPECT_TRUE(ViolationsOf(options).empty()) << file;
    EXPECT_NE(PrintOptions(options), PrintOptions(KestrelOptions())) << file << " changes nothing";
    EXPECT_THAT(ReadFile(file), ::testing::HasSubstr("KESTREL_SOURCE=")) << file;
  }
}

// The variables that the unit expands are in its environment file, and that file names an example.
TEST(ExamplesTest, UnitAndEnvironmentFileAgree) {
  const std::string unit = ReadFile(kExamples + "/kestrel-fly.service");
  const std::string environment = ReadFile(kExamples + "/kestrel-fly.env");
  const std::regex variable("KESTREL_[A-Z]+");
  int count = 0;
  for (std::sregex_iterator name(unit.begin(), unit.end(), variable), end; name != end; ++name) {
    EXPECT_THAT(environment, ::testing::HasSubstr(fmt::format("\n{}=", name->str())))
        << name->str();
    ++count;
  }
  EXPECT_GE(count, 5);
  std::smatch config;
  ASSERT_TRUE(std::regex_search(environment, config,
                                std::regex("\nKESTREL_CONFIG=/etc/kestrel/([a-z_]+\\.yaml)\n")));
  EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(kExamples) / config[1].str()))
      << config[1];
}

class ExampleCommandTest : public CommandTest {};

// The options of the unit's command exist: the command fails only because of the camera.
TEST_F(ExampleCommandTest, CommandOfUnitIsValid) {
  const Outcome outcome = Run("fly /dev/video987 --camera " + folder_ / "none.yaml" + " --config " +
                              kExamples + "/usb_global_shutter.yaml --autopilot " +
                              "serial:///dev/ttyAMA0:921600 --record " + folder_ / "r");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("none.yaml: no such file"));
}

}  // namespace
}  // namespace kestrel
