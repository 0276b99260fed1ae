// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/options/field_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

constexpr char kTargetFile[] =
    "fly:\n  source: flight\nlanding:\n  target:\n    kind: apriltag  # ours\n    id: 3\n";

AutopilotState StateOf(bool is_armed) {
  AutopilotState state;
  state.is_here = true;
  state.is_armed = is_armed;
  return state;
}

class FieldSettingsTest : public ::testing::Test {
 protected:
  FieldSettings Settings(const std::vector<std::string>& given = {}) const {
    return FieldSettings(file_, given, ReadKestrelOptions(file_, given));
  }
  static std::string ValueOf(const ConsoleSettings& state, const std::string& name) {
    for (const ConsoleSetting& one : state.settings) {
      if (one.name == name) return one.value;
    }
    return "is not there";
  }
  void ExpectRefused(FieldSettings settings, const std::string& setting, const std::string& words,
                     const std::optional<AutopilotState>& autopilot = std::nullopt) const {
    const ConsoleSettings state = settings.Save({setting}, autopilot);
    EXPECT_THAT(state.error, HasSubstr(words)) << setting;
    EXPECT_EQ(state.saved, "");
    EXPECT_EQ(ReadFile(file_), kTargetFile);
  }

  TestFolder folder_;
  std::string file_ = folder_.Write("kestrel.yaml", kTargetFile);
};

TEST_F(FieldSettingsTest, ShowsAndSavesSettings) {
  FieldSettings settings = Settings();
  EXPECT_EQ(ValueOf(settings.State(), "landing.target.id"), "3");
  const ConsoleSettings state = settings.Save(
      {"landing.target.id=7", "landing.target.size_m=0.4", "fly.control_exposure=true",
       "fly.exposure.max_exposure_s=0.004", "fly.source=rtsp://10.0.0.2:554/main"},
      StateOf(/*is_armed=*/false));
  EXPECT_EQ(state.error, "");
  EXPECT_EQ(state.saved, "saved to " + file_ + "; restart kestrel fly");
  EXPECT_EQ(ValueOf(state, "landing.target.id"), "7");
  const KestrelOptions next = ReadKestrelOptions(file_, {});
  EXPECT_EQ(next.landing.target.kind, "apriltag");
  EXPECT_EQ(next.landing.target.id, 7);
  EXPECT_EQ(next.landing.target.size_m, 0.4);
  EXPECT_TRUE(next.fly.control_exposure);
  EXPECT_EQ(next.fly.exposure.max_exposure_s, 0.004);
  EXPECT_EQ(next.fly.source, "rtsp://10.0.0.2:554/main");
  EXPECT_THAT(ReadFile(file_), HasSubstr("kind: apriltag  # ours\n"));
}

// In the words of the command line.
TEST_F(FieldSettingsTest, RefusesWrongValues) {
  for (const std::string setting :
       {"landing.target.id=three", "landing.target.kind=circle", "landing.target.size_m=-1",
        "fly.control_exposure=maybe", "fly.exposure.max_exposure_s=0"}) {
    std::string words;
    try {
      ReadKestrelOptions(file_, {setting});
    } catch (const InputError& error) {
      words = error.what();
    }
    ASSERT_NE(words, "") << setting;
    ExpectRefused(Settings(), setting, words);
  }
  ExpectRefused(Settings(), "landing.target.kind=nested", "nested.board");
  ExpectRefused(Settings(), "fly.source=/dev/video63", "/dev/video63");
  ExpectRefused(Settings(), "fly.source=flights", "flights: no such file or folder");
  ExpectRefused(Settings(), "fly.source=", "expected a camera or a recording");
  ExpectRefused(Settings(), "console.token=0123456789abcdef", "no setting of this page");
}

TEST_F(FieldSettingsTest, KeepsSettingOfCommandLine) {
  const FieldSettings settings = Settings({"landing.target.id=9"});
  EXPECT_EQ(ValueOf(settings.State(), "landing.target.id"), "9");
  EXPECT_TRUE(settings.State().settings.back().is_given);
  ExpectRefused(settings, "landing.target.id=4", "command line");
}

TEST_F(FieldSettingsTest, SavesNothingWithoutFileOrWhileArmed) {
  ExpectRefused(FieldSettings("", {}, {}), "landing.target.id=4", "--config FILE");
  ExpectRefused(Settings(), "landing.target.id=4", "the UAV is armed", StateOf(/*is_armed=*/true));
}

}  // namespace
}  // namespace kestrel
