// SPDX-License-Identifier: BSD-3-Clause
// Limits for the landing detector when it gets wrong information and when the print is not flat and
// rigid, on few stills; bench/robustness_accuracy.cc measures it in full.
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "landing_falsehoods.h"
#include "landing_frames.h"
#include "landing_score.h"

namespace kestrel {
namespace {

constexpr int kThreads = 2;
constexpr int kStillsPerAltitude = 8;
constexpr double kMinShareOfRight = 0.95;
constexpr double kMaxCenterErrorPx = 2;  // for 95 % of the stills

LandingTally Score(const LandingFrameSet& set, const CameraIntrinsics& camera, HintOf hint) {
  const LandingPatternDetector detector{CameraModel(camera), {}};
  return LandingTally(ScoreFrames(detector, set.frames.size(), kThreads, hint,
                                  [&](std::size_t i) { return set.frames[i]; }));
}

// The figures and their distances from the limits go to the test's report (--gtest_output).
void ExpectAsGood(std::string_view what, const LandingTally& tally, const LandingTally& right) {
  const std::string name(what);
  testing::Test::RecordProperty(
      name, fmt::format("{} of {} found, {} wrong, centre errors 95 % {:.2f} px, mean NEES {:.1f}",
                        tally.found, tally.frames, tally.wrong,
                        Quantile(tally.center_errors_px, 0.95), Mean(tally.nees)));
  EXPECT_GE(tally.found, kMinShareOfRight * right.found) << name << ", of " << tally.frames;
  EXPECT_LE(Quantile(tally.center_errors_px, 0.95), kMaxCenterErrorPx) << name;
  EXPECT_LE(tally.wrong, right.wrong + 1) << name;
}

TEST(LandingRobustnessTest, WrongCalibrationCostsLittle) {
  const LandingFrameSet stills = RenderStills(kStillsPerAltitude, PrintErrors().front(), kThreads);
  LandingTally right;
  for (const CalibrationError& error : CalibrationErrors()) {
    const LandingTally tally = Score(stills, error.apply(stills.camera), NoHint);
    if (right.frames == 0) {
      right = tally;
      ASSERT_GE(right.FoundShare(), 0.9);
    }
    ExpectAsGood(error.name, tally, right);
  }
}

TEST(LandingRobustnessTest, WrongHintCostsNothing) {
  const LandingFrameSet stills = RenderStills(kStillsPerAltitude, PrintErrors().front(), kThreads);
  LandingTally right;
  for (const GivenHint& given : GivenHints()) {
    const LandingTally tally = Score(stills, stills.camera, given.make);
    if (right.frames == 0) right = tally;
    ExpectAsGood(given.name, tally, right);
  }
}

TEST(LandingRobustnessTest, UnevenPrintCostsLittle) {
  LandingTally flat;
  for (const PrintError& print : PrintErrors()) {
    const LandingFrameSet stills = RenderStills(kStillsPerAltitude, print, kThreads);
    const LandingTally tally = Score(stills, stills.camera, NoHint);
    if (flat.frames == 0) flat = tally;
    ExpectAsGood(print.name, tally, flat);
  }
}

// Near the pattern a wrong focal length distorts the pose. The edges show it, and the covariance
// grows.
TEST(LandingRobustnessTest, CovarianceGrowsWithWrongFocalLength) {
  constexpr std::size_t kStills = 30;
  constexpr double kMaxDistance_m = 1.2;
  constexpr double kDegreesOfFreedom = 3;
  constexpr double kMaxNees = 6;  // mean per degree of freedom; 1 for the right lens
  LandingStillOptions options;
  options.min_altitude_m = 0.5;
  options.max_altitude_m = 1;
  const LandingStillMaker maker(options);
  LandingFrameSet near{"near", options.camera, {}};
  for (std::uint64_t seed = 7'000'000; near.frames.size() < kStills; ++seed) {
    if (maker.PlacePattern(seed).camera_from_target.translation.norm() > kMaxDistance_m) continue;
    near.frames.push_back(FrameFromStill(maker, near.name, seed));
  }
  for (const double factor : {0.9, 1.0, 1.1}) {
    CameraIntrinsics camera = near.camera;
    camera.fx_px *= factor;
    camera.fy_px *= factor;
    const LandingTally tally = Score(near, camera, NoHint);
    RecordProperty(fmt::format("focal length times {}", factor),
                   fmt::format("{} found, NEES per degree of freedom: mean {:.2f}, median {:.2f}",
                               tally.found, Mean(tally.nees) / kDegreesOfFreedom,
                               Quantile(tally.nees, 0.5) / kDegreesOfFreedom));
    EXPECT_GE(tally.FoundShare(), 0.9) << factor;
    EXPECT_LE(Mean(tally.nees) / kDegreesOfFreedom, kMaxNees) << factor;
  }
}

}  // namespace
}  // namespace kestrel
