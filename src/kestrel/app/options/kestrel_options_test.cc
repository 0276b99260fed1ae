// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/options/kestrel_options.h"

#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

TEST(KestrelOptions, DefaultsAreValid) { EXPECT_TRUE(ViolationsOf(KestrelOptions()).empty()); }

TEST(KestrelOptions, SettingsOverrideDefaults) {
  const KestrelOptions options = ReadKestrelOptions(
      "", {"landing.detector.pattern.outer_diameter_m=1.2", "landing.target_height_m=0.5"});
  EXPECT_EQ(options.landing.detector.pattern.outer_diameter_m, 1.2);
  EXPECT_EQ(options.landing.target_height_m, 0.5);
}

TEST(KestrelOptions, PrintedTextsRoundTrip) {
  for (const char* text : {"videotestsrc ! video/x-raw", "a: b", "a #b", "null", "", "[1]"}) {
    KestrelOptions options, again;
    options.fly.source = text;
    again.fly.source = "another";
    ReadOptionFields(PrintOptions(options), "printed", FieldsOf(again));
    EXPECT_EQ(again.fly.source, text);
  }
}

TEST(KestrelOptions, ViolationsNameFullKey) {
  try {
    ReadKestrelOptions("", {"landing.hint_sigma_m=-1", "landing.detector.min_quality=7"});
    FAIL() << "expected an InputError";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("landing.hint_sigma_m"), std::string::npos) << message;
    EXPECT_NE(message.find("landing.detector.min_quality"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace kestrel
