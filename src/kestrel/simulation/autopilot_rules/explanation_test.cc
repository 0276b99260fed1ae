// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilot_rules/explanation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

using ::testing::HasSubstr;

// (10, 20, -30) plus 2 m along (cos 60, sin 60), 1 m along (-sin 60, cos 60), 5 m down.
const Eigen::Vector3d kPatternInNed(10.134, 22.232, -25);

TEST(ExplanationTest, EachAutopilotUnderstandsItsProfile) {
  const auto ardupilot = UnderstandingOf({}, LinkProfile::kArduPilot);
  ASSERT_TRUE(ardupilot.ardupilot_in_ned);
  EXPECT_LT((*ardupilot.ardupilot_in_ned - kPatternInNed).norm(), 0.01);
  const auto px4 = UnderstandingOf({}, LinkProfile::kPx4);
  ASSERT_TRUE(px4.px4_in_ned);
  EXPECT_LT((*px4.px4_in_ned - kPatternInNed).norm(), 0.01);
  const auto vte = UnderstandingOf({}, LinkProfile::kPx4Vte);
  ASSERT_TRUE(vte.px4_in_ned);
  EXPECT_LT((*vte.px4_in_ned - kPatternInNed).norm(), 0.01);
}

TEST(ExplanationTest, OtherAutopilotIgnoresProfile) {
  const auto ardupilot = UnderstandingOf({}, LinkProfile::kArduPilot);
  EXPECT_FALSE(ardupilot.px4_in_ned);
  EXPECT_THAT(ardupilot.px4_text, HasSubstr("frame 12 unsupported"));
  const auto px4 = UnderstandingOf({}, LinkProfile::kPx4);
  EXPECT_FALSE(px4.ardupilot_in_ned);
  EXPECT_THAT(px4.ardupilot_text, HasSubstr("Frame not supported"));
}

TEST(ExplanationTest, PrintsEachField) {
  const std::string text = Explain({});
  for (const char* const line :
       {"angle_x        0.1974 rad", "distance       5.4772 m", "frame          12",
        "x              10.1340 m", "TARGET_RELATIVE (511)", "pos_std        (0.0300, 0.0300"}) {
    EXPECT_THAT(text, HasSubstr(line));
  }
}

}  // namespace
}  // namespace kestrel
