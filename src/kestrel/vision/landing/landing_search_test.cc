// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/landing_search.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

class LandingSearchTest : public ::testing::Test {
 protected:
  // Returns all findings of a search, accepted or not.
  std::vector<PrintFinding> Findings(const Print& print, const RigidTransform& pose) {
    std::vector<PrintFinding> findings;
    const FindingObserver observer = [&](const PrintFinding& f) { findings.push_back(f); };
    const TargetHint nothing;
    const cv::Mat image = DrawPrint(models_.camera, models_.options.pattern, print, pose);
    LandingSearch(models_, image, nothing, &buffers_, &observer).Run();
    return findings;
  }
  static const PrintFinding& Best(const std::vector<PrintFinding>& findings) {
    return *std::max_element(
        findings.begin(), findings.end(),
        [](const PrintFinding& a, const PrintFinding& b) { return a.log_odds < b.log_odds; });
  }

  const LandingPattern pattern_{};
  const LandingModels models_{TestPrintCamera(), {}};
  LandingWorkspace::Buffers buffers_;
};

// An ideal print raises no doubts except those that its size raises.
TEST_F(LandingSearchTest, IdealPrintRaisesNoDoubts) {
  for (const double distance : {1.1, 1.7, 3.0, 5.5, 7.5}) {
    const auto findings =
        Findings(SpokedPrint(pattern_, 4), PrintPose({0.05, -0.04, distance}, 0.25, 1, 0.3));
    ASSERT_FALSE(findings.empty()) << distance;
    const PrintFinding& best = Best(findings);
    for (const PrintDoubt doubt :
         {PrintDoubt::kInklessArm, PrintDoubt::kDarkQuadrants, PrintDoubt::kInkOnWhite,
          PrintDoubt::kDarkHub, PrintDoubt::kDarkBoard, PrintDoubt::kDarkCorners,
          PrintDoubt::kFaintArm, PrintDoubt::kBrokenRing, PrintDoubt::kFrameCorners,
          PrintDoubt::kInside, PrintDoubt::kHidden, PrintDoubt::kShadows}) {
      EXPECT_LT(best.doubts[doubt], 0.12)
          << "doubt " << static_cast<int>(doubt) << " at " << distance << " m";
    }
    EXPECT_LT(best.doubts[PrintDoubt::kOtherSpokes], 0.3) << distance;
    EXPECT_LT(std::exp(best.doubts[PrintDoubt::kUnlike]), 0.05) << distance;
    EXPECT_LT(std::exp(best.doubts[PrintDoubt::kOtherFigure]), 0.08) << distance;
    EXPECT_LT(std::exp(best.doubts[PrintDoubt::kUncertain]), 0.02) << distance;
    if (best.kind == PrintKind::kByEdges) {
      EXPECT_LT(best.doubts[PrintDoubt::kArmEdges], 0.1) << distance;
      EXPECT_LT(std::exp(best.doubts[PrintDoubt::kScatter]), 0.01) << distance;
      EXPECT_LT(std::exp(best.doubts[PrintDoubt::kMisfit]), 0.01) << distance;
    }
    EXPECT_GT(ProbabilityOf(best.log_odds), 0.85) << distance;
  }
}

// Each defect raises the doubt of its name.
TEST_F(LandingSearchTest, MissingOrExtraInkRaisesDoubts) {
  const Print three_arms = [this](double x, double y) {
    return SpokedPrint(pattern_, 4)(x, y) && !(x > 0.06 && std::abs(y) < 0.06 && x < 0.39);
  };
  const Print frame = [this](double x, double y) {
    const double sum = std::abs(x) + std::abs(y);  // corners beyond the ends of the arms
    return (sum > 0.5 && sum < 0.62) || SpokedPrint(pattern_, 4)(x, y);
  };
  const Print dark_board = [this](double x, double y) {
    const double radius = std::hypot(x, y);
    return SpokedPrint(pattern_, 4)(x, y) || radius > 0.62;
  };
  struct Case {
    Print print;
    PrintDoubt doubt;
    double least;
  };
  const Case cases[] = {{three_arms, PrintDoubt::kInklessArm, 0.5},
                        {SpokedPrint(pattern_, 8), PrintDoubt::kOtherSpokes, 0.5},
                        {frame, PrintDoubt::kDarkCorners, 0.1},
                        {dark_board, PrintDoubt::kDarkBoard, 0.15}};
  for (const double distance : {1.7, 5.5}) {
    const RigidTransform pose = PrintPose({0.05, -0.04, distance}, 0.25, 1, 0.3);
    const double ideal = Best(Findings(SpokedPrint(pattern_, 4), pose)).log_odds;
    for (const Case& c : cases) {
      const auto findings = Findings(c.print, pose);
      if (findings.empty()) continue;  // rejected before its pose was known
      const PrintFinding& best = Best(findings);
      EXPECT_GT(best.doubts[c.doubt], c.least)
          << "doubt " << static_cast<int>(c.doubt) << " at " << distance << " m";
      EXPECT_LT(best.log_odds, ideal - 2)
          << "doubt " << static_cast<int>(c.doubt) << " at " << distance << " m";
    }
  }
}

// A clock that advances by a millisecond whenever it is read, once a step.
std::chrono::steady_clock::time_point StepClock() {
  static std::chrono::steady_clock::time_point time;
  return time += std::chrono::milliseconds(1);
}

// With time for a quarter of the steps, a pattern in view is found within four frames, whatever
// step the search has come to.
TEST_F(LandingSearchTest, FindsPatternsInFourFramesAtQuarterOfTime) {
  constexpr int kSteps = static_cast<int>(kSearchSteps), kFrames = 4;
  LandingModels bounded(TestPrintCamera(), {});
  bounded.now = &StepClock;
  TargetHint hint;
  hint.max_search_ms = (kSteps + kFrames - 1) / kFrames - 0.5;
  for (const double distance : {0.8, 1.7, 4.0, 9.0, 13.0}) {
    const cv::Mat image = DrawPrint(models_.camera, pattern_, SpokedPrint(pattern_, 4),
                                    PrintPose({0.05, -0.04, distance}, 0.25, 1, 0.3));
    for (int first = 0; first < kSteps; ++first) {
      hint.first_step = first;
      int frames = 0;
      for (bool is_found = false; !is_found && frames <= kFrames; ++frames) {
        const TargetReport report = LandingSearch(bounded, image, hint, &buffers_).Run();
        is_found = report.detection.has_value();
        hint.first_step = report.diagnostics.next_step;
      }
      EXPECT_LE(frames, kFrames) << distance << " m, from step " << first;
    }
  }
}

}  // namespace
}  // namespace kestrel
