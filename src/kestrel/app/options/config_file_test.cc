// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/options/config_file.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

constexpr char kFile[] = R"(# The field at the river.
landing:
  target:     # ours
    # printed in spring
    kind: "aruco"   # not the old one
    id: 3
  still: false

# How it flies.
fly:
  rate_hz: 20
)";

std::string With(const std::string& yaml, const std::string& setting) {
  return WithSetting(yaml, setting, "kestrel.yaml");
}

TEST(WithSetting, ReplacesSingleValueOnly) {
  std::string expected = kFile;
  expected.replace(expected.find("\"aruco\""), 7, "apriltag");
  EXPECT_EQ(With(kFile, "landing.target.kind=apriltag"), expected);
  expected = kFile;
  expected.replace(expected.find("id: 3"), 5, "id: 17");
  EXPECT_EQ(With(kFile, "landing.target.id=17"), expected);
}

TEST(WithSetting, AddsLineToGroup) {
  std::string expected = kFile;
  expected.insert(expected.find("    # printed"), "    size_m: 0.4\n");
  EXPECT_EQ(With(kFile, "landing.target.size_m=0.4"), expected);
}

TEST(WithSetting, AddsGroups) {
  std::string expected = kFile;
  expected.insert(expected.find("  rate_hz"), "  exposure:\n    max_exposure_s: 0.002\n");
  EXPECT_EQ(With(kFile, "fly.exposure.max_exposure_s=0.002"), expected);
  EXPECT_EQ(With("fly:", "fly.rate_hz=30"), "fly:\n  rate_hz: 30\n");
  EXPECT_EQ(With("# empty", "fly.rate_hz=30"), "# empty\nfly:\n  rate_hz: 30\n");
  EXPECT_EQ(With("", "fly.rate_hz=30"), "fly:\n  rate_hz: 30\n");
  EXPECT_EQ(With("fly:\n  rate_hz: 30\n", "landing.still=true"),
            "fly:\n  rate_hz: 30\nlanding:\n  still: true\n");
}

TEST(WithSetting, QuotesAmbiguousText) {
  for (const std::string text :
       {"v4l2src device=/dev/video2 ! image/jpeg,width=640 ! jpegdec", "a: b", "a #b", "'", "null",
        "rtsp://10.0.0.2:554/main", "a \"b\" \\c", "[1]", "grün"}) {
    const std::string changed = With(kFile, "fly.keep_folder=" + text);
    KestrelOptions options;
    ReadOptionFields(changed, "", FieldsOf(options));
    EXPECT_EQ(options.fly.keep_folder, text) << changed;
    // A quoted value is replaced as well.
    EXPECT_EQ(With(changed, "fly.keep_folder=a"), With(kFile, "fly.keep_folder=a"));
  }
}

TEST(WithSetting, RefusesUnchangeableOption) {
  for (const std::string yaml :
       {"landing: {target: {id: 3}}\n", "landing:\n  target: {kind: aruco}\n", "a: 1\n",
        "landing:\n  target:\n    id: >\n      3\n"}) {
    EXPECT_THROW(With(yaml, "landing.target.id=4"), InputError) << yaml;
  }
  EXPECT_THROW(With(kFile, "landing.target.id=four"), InputError);
  EXPECT_THROW(With(kFile, "landing.target.nr=4"), InputError);
}

TEST(SaveSettings, ChangesFileBehindLink) {
  const TestFolder folder;
  const std::string file = folder.Write("own.yaml", kFile);
  const std::string link = folder / "kestrel.yaml";
  std::filesystem::create_symlink(file, link);
  SaveSettings(link, {"landing.target.id=4", "fly.rate_hz=30"});
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  const KestrelOptions options = ReadKestrelOptions(file, {});
  EXPECT_EQ(options.landing.target.id, 4);
  EXPECT_EQ(options.fly.rate_hz, 30);
  EXPECT_THAT(ReadFile(file), ::testing::HasSubstr("# printed in spring"));
}

}  // namespace
}  // namespace kestrel
