// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/target/target_detection.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(DetectionMethod, EachMethodHasItsOwnWord) {
  EXPECT_STREQ(ToString(DetectionMethod::kRing), "ring");
  EXPECT_STREQ(ToString(DetectionMethod::kPartial), "partial");
  std::set<std::string> words;
  for (const DetectionMethod method : kDetectionMethods) words.insert(ToString(method));
  EXPECT_EQ(words.size(), kDetectionMethods.size());
  EXPECT_EQ(words.count(""), 0u);
}

TEST(LandingStage, WordsMatchTables) {
  EXPECT_STREQ(ToString(LandingStage::kBinarize), "binarize");
  EXPECT_STREQ(ToString(LandingStage::kLocate), "locate");
  EXPECT_STREQ(ToString(LandingStage::kFound), "found");
}

TEST(SeenParts, KeepsPartsUpToCapacity) {
  SeenParts parts;
  EXPECT_TRUE(parts.all().empty());
  for (std::size_t tag = 0; tag < 2 * SeenParts::kMost; ++tag) parts.Add({"tag", tag, 10});
  ASSERT_EQ(parts.all().size(), SeenParts::kMost);
  EXPECT_EQ(parts.all().front().tag, 0);
  EXPECT_EQ(parts.all().back().tag, SeenParts::kMost - 1);
}

TEST(MissInWords, ReportsInViewOnlyForPadLikeFindings) {
  TargetReport report;
  report.reason = "its own reason";
  for (const LandingStage stage :
       {LandingStage::kAreas, LandingStage::kRing, LandingStage::kCross, LandingStage::kMatch}) {
    report.reached = stage;
    EXPECT_EQ(MissInWords(report), "not in view") << ToString(stage);
    EXPECT_EQ(MissInWords(report, /*is_expected=*/true), "its own reason") << ToString(stage);
  }
  report.is_another_pad = true;
  EXPECT_EQ(MissInWords(report), "its own reason");
  report.is_another_pad = false;
  for (const LandingStage stage : {LandingStage::kBinarize, LandingStage::kLocate}) {
    report.reached = stage;
    EXPECT_EQ(MissInWords(report), "its own reason") << ToString(stage);
  }
}

}  // namespace
}  // namespace kestrel
