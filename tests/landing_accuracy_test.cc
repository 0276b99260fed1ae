// SPDX-License-Identifier: BSD-3-Clause
// Limits for the landing detector, on few stills and on the data sets if they are there;
// bench/kestrel_accuracy.cc measures it in full.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "landing_frames.h"
#include "landing_score.h"
#include "real_frames.h"

namespace kestrel {
namespace {

constexpr int kThreads = 2;

LandingTally ScoreSets(const std::vector<LandingFrameSet>& sets, HintOf hint) {
  LandingTally tally;
  for (const LandingFrameSet& set : sets) {
    const LandingPatternDetector detector(CameraModel(set.camera), {});
    for (const LandingScore& score : ScoreFrames(detector, set.frames.size(), kThreads, hint,
                                                 [&](std::size_t i) { return set.frames[i]; })) {
      tally.Add(score);
    }
  }
  return tally;
}

class LandingStillsTest : public testing::TestWithParam<std::size_t> {};

TEST_P(LandingStillsTest, FindsPatternAtItsPlace) {
  constexpr double kMinFoundShare[] = {0.85, 0.85, 0.9, 0.9, 0.85};
  constexpr int kStills = 40;
  const AltitudeBin& bin = kAltitudeBins[GetParam()];
  LandingStillOptions options;
  options.min_altitude_m = bin.min_m;
  options.max_altitude_m = bin.max_m;
  const LandingStillMaker maker(options);
  const LandingPatternDetector detector(maker.camera(), {});
  const LandingTally tally(ScoreFrames(detector, kStills, kThreads, NoHint, [&](std::size_t i) {
    return FrameFromStill(maker, bin.Name(), 100 * GetParam() + i);
  }));
  EXPECT_GE(tally.FoundShare(), kMinFoundShare[GetParam()]);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_LE(Quantile(tally.center_errors_px, 0.5), 0.2);
  EXPECT_LE(Quantile(tally.position_errors, 0.5), 0.01);
}
INSTANTIATE_TEST_SUITE_P(Altitudes, LandingStillsTest,
                         testing::Range<std::size_t>(0, kAltitudeBins.size()),
                         [](const auto& info) {
                           const AltitudeBin& bin = kAltitudeBins[info.param];
                           return "UpTo" + std::to_string(static_cast<int>(bin.max_m)) + "m";
                         });

TEST(LandingLookalikesTest, AreNotTakenForPattern) {
  constexpr int kStills = 60;
  LandingStillOptions options;
  options.min_altitude_m = 0.35;
  options.max_altitude_m = 14;
  const LandingStillMaker maker(options);
  const LandingPatternDetector detector(maker.camera(), {});
  for (const LandingScore& score : ScoreFrames(
           detector, kStills, kThreads, NoHint,
           [&](std::size_t i) { return FrameFromLookalikes(maker, "look-alikes", 600 + i); })) {
    EXPECT_TRUE(score.outcome == LandingOutcome::kQuiet) << score.name;
  }
}

TEST(LandingRealTest, FindsPatternAtItsPlace) {
  const std::vector<LandingFrameSet> sets = ReadLandingReal(KESTREL_DATA_DIR);
  if (sets.empty()) GTEST_SKIP() << kNoRealFrames;
  const LandingTally tally = ScoreSets(sets, NoHint);
  EXPECT_EQ(tally.frames, 349);
  EXPECT_GE(tally.FoundShare(), 0.99);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_EQ(tally.false_detections, 0);
  EXPECT_EQ(tally.partial_right, tally.partial_found);
  EXPECT_LE(Quantile(tally.center_errors_px, 0.5), 0.3);
  EXPECT_LE(Quantile(tally.center_errors_px, 0.95), 1);
}

class LandingHardTest : public testing::TestWithParam<HintOf> {};

TEST_P(LandingHardTest, FindsPatternAtItsPlace) {
  const std::vector<LandingFrameSet> sets = ReadLandingHard(KESTREL_DATA_DIR);
  if (sets.empty()) GTEST_SKIP() << kNoRealFrames;
  const LandingTally tally = ScoreSets(sets, GetParam());
  EXPECT_EQ(tally.frames, 100);
  EXPECT_EQ(tally.negatives, 30);
  EXPECT_GE(tally.FoundShare(), 0.86);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_EQ(tally.false_detections, 0);
  EXPECT_LE(Quantile(tally.position_errors, 0.5), 0.01);
}
INSTANTIATE_TEST_SUITE_P(Hints, LandingHardTest, testing::Values(NoHint, AttitudeHint),
                         [](const auto& info) {
                           return info.param == NoHint ? "None" : "Attitude";
                         });

}  // namespace
}  // namespace kestrel
