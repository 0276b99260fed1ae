// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/replay_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

TEST(ReplayOptionsTest, AcceptsEveryOfferedOption) {
  LandingPipelineOptions options;
  options.detector.min_quality = 0.75;
  const ConsoleOptionList list = ReplayOptions(options);
  std::vector<std::string> settings;
  for (const ConsoleOption& option : list.options) {
    settings.push_back(option.name + "=" + option.value);
    EXPECT_FALSE(option.meaning.empty()) << option.name;
  }
  const LandingPipelineOptions same = WithSettings(LandingPipelineOptions(), settings);
  EXPECT_EQ(same.detector.min_quality, 0.75);
  EXPECT_EQ(same.tracker.max_speed_mps, options.tracker.max_speed_mps);
}

TEST(ReplayOptionsTest, OffersOptionsOfHunt) {
  HuntPipelineOptions options;
  options.detector.min_pixels = 40;
  const ConsoleOptionList list = ReplayOptions(options);
  EXPECT_THAT(list.options, ::testing::Each(::testing::Field(&ConsoleOption::name,
                                                             ::testing::StartsWith("hunt."))));
  std::vector<std::string> settings;
  for (const ConsoleOption& option : list.options) {
    settings.push_back(option.name + "=" + option.value);
  }
  EXPECT_EQ(WithSettings(HuntPipelineOptions(), settings).detector.min_pixels, 40);
  for (const char* setting :
       {"landing.still=true", "hunt.map.capacity=1000000000", "hunt.pose_gap_s=1000000000"}) {
    EXPECT_THROW(WithSettings(HuntPipelineOptions(), {setting}), InputError) << setting;
  }
}

TEST(ReplayOptionsTest, RefusesOtherSettings) {
  for (const char* setting :
       {"", "=", "landing.", "landing.pose_gap_s=1000000000", "still=true", "landing.still",
        "landing.still=perhaps", "landing.detector.min_quality=2", "landing.detector.min_ring_px=x",
        "hunt.still=true", "fly.keep_folder=/tmp", "landing.target.kind=helipad"}) {
    EXPECT_THROW(WithSettings(LandingPipelineOptions(), {setting}), InputError) << setting;
  }
}

}  // namespace
}  // namespace kestrel
