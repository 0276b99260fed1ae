// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/score/detection_choice.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

class DetectionChoiceTest : public ::testing::Test {
 protected:
  DetectionChoice Choice(double min_quality, const FindingObserver* observer = nullptr) {
    return {min_quality, observer, &log_};
  }

  TargetReport report_;
  SearchLog log_{&report_};
};

PrintFinding FindingAt(const Eigen::Vector2d& center_px, double log_odds) {
  PrintFinding finding;
  finding.kind = PrintKind::kByEdges;
  finding.method = DetectionMethod::kRing;
  finding.location.camera_from_target = PrintPose({0.1, 0, 5}, 0.3, 1, 0.2);
  finding.location.covariance = 1e-4 * Eigen::Matrix<double, 6, 6>::Identity();
  finding.location.edge_rms_px = 0.3;
  finding.center_px = center_px;
  finding.diameters_px = {40, 36};
  finding.log_odds = log_odds;
  return finding;
}

PrintDoubts RandomDoubts(Random* random) {
  PrintDoubts doubts;
  for (std::size_t i = 0; i < kPrintDoubts; ++i) {
    doubts[static_cast<PrintDoubt>(i)] = random->Uniform(-6, 0.3);
  }
  return doubts;
}

// MayAccept never rejects a finding that would be accepted in the end, no matter how few of the
// doubts are known and how much the prior takes.
TEST_F(DetectionChoiceTest, EarlyCheckRejectsNoAcceptableFinding) {
  Random random(1);
  int refused_early = 0, accepted = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const double min_quality = random.Uniform(0.05, 0.95);
    const DetectionChoice choice = Choice(min_quality);
    PrintFinding finding = FindingAt({100, 100}, 0);
    finding.kind = random.Chance(0.5) ? PrintKind::kByEdges : PrintKind::kAsAWhole;
    PrintDoubts known;
    const PrintDoubts all = RandomDoubts(&random);
    for (std::size_t i = 0; i < kPrintDoubts; ++i) {
      const auto doubt = static_cast<PrintDoubt>(i);
      if (random.Chance(0.6)) known[doubt] = all[doubt];
    }
    finding.doubts = all;
    finding.log_odds = PrintLogOdds(finding.kind, all) - random.Uniform(0, 2);
    accepted += choice.Accepts(finding);
    if (choice.MayAccept(finding.kind, known)) continue;
    ++refused_early;
    EXPECT_FALSE(choice.Accepts(finding)) << trial;
  }
  EXPECT_GT(refused_early, 100);
  EXPECT_GT(accepted, 100);
}

TEST_F(DetectionChoiceTest, ObserverSeesEveryFinding) {
  std::vector<double> seen;
  const FindingObserver observer = [&](const PrintFinding& f) { seen.push_back(f.log_odds); };
  DetectionChoice choice = Choice(0.5, &observer);
  PrintDoubts all_bad;
  for (std::size_t i = 0; i < kPrintDoubts; ++i) all_bad[static_cast<PrintDoubt>(i)] = 2;
  EXPECT_TRUE(choice.MayAccept(PrintKind::kByEdges, all_bad));
  EXPECT_FALSE(choice.Add(FindingAt({10, 10}, -3)));
  EXPECT_TRUE(choice.Add(FindingAt({90, 10}, 2)));
  EXPECT_EQ(seen, (std::vector<double>{-3, 2}));
}

TEST_F(DetectionChoiceTest, ChoosesMostProbableFinding) {
  Random random(2);
  for (int trial = 0; trial < 300; ++trial) {
    const double min_quality = random.Uniform(0.1, 0.9);
    DetectionChoice choice = Choice(min_quality);
    std::vector<PrintFinding> findings;
    const int count = random.Integer(1, 6);
    for (int i = 0; i < count; ++i) {
      findings.push_back(FindingAt({60.0 * i, 40}, random.Uniform(-4, 6)));
      EXPECT_EQ(choice.Add(findings.back()),
                ProbabilityOf(findings.back().log_odds) >= min_quality);
    }
    const auto best = std::max_element(
        findings.begin(), findings.end(),
        [](const PrintFinding& a, const PrintFinding& b) { return a.log_odds < b.log_odds; });
    const auto detection = choice.Detection();
    ASSERT_EQ(detection.has_value(), ProbabilityOf(best->log_odds) >= min_quality);
    if (!detection) continue;
    EXPECT_EQ(detection->center_px, best->center_px);
    EXPECT_DOUBLE_EQ(detection->quality, ProbabilityOf(best->log_odds));
    EXPECT_EQ(detection->semi_major_px, 20);
    EXPECT_EQ(detection->diagnostics.misfit_px, best->location.misfit_px);
    EXPECT_FALSE(detection->diagnostics.mirror_camera_from_target);
  }
}

TEST_F(DetectionChoiceTest, ReportsReasonOfImprobableFinding) {
  DetectionChoice choice = Choice(0.5);
  PrintFinding finding = FindingAt({10, 10}, -2);
  finding.doubts[PrintDoubt::kDarkBoard] = 1;
  EXPECT_FALSE(choice.Add(finding));
  EXPECT_EQ(report_.reached, LandingStage::kLocate);
  EXPECT_EQ(report_.reason, "there is no white board around the ring");
  EXPECT_FALSE(choice.Detection());
  EXPECT_TRUE(choice.Add(FindingAt({90, 10}, 2)));
  EXPECT_EQ(report_.reached, LandingStage::kFound);
  EXPECT_EQ(report_.reason, "");
}

TEST_F(DetectionChoiceTest, AcceptsAllAtZeroAndNoneAtOne) {
  DetectionChoice any = Choice(0);
  EXPECT_TRUE(any.Add(FindingAt({0, 0}, -50)));
  DetectionChoice none = Choice(1);
  EXPECT_FALSE(none.Add(FindingAt({0, 0}, 50)));
}

// The pose with the smaller residuals is reported, and the other pose of the same ring as its
// mirror. The covariance reaches the other one.
TEST_F(DetectionChoiceTest, ReportsMirrorPoseOfRing) {
  PrintFinding right = FindingAt({100, 100}, 3);
  PrintFinding mirror = FindingAt({100.5, 100}, 3.5);
  mirror.location.camera_from_target = PrintPose({0.1, 0.02, 5.1}, 0.3, 1 + 3.14, 0.2);
  right.location.edge_rms_px = 0.2;
  mirror.location.edge_rms_px = 0.3;
  for (const bool right_first : {true, false}) {
    DetectionChoice choice = Choice(0.5);
    choice.Add(right_first ? right : mirror);
    choice.Add(right_first ? mirror : right);
    const auto detection = choice.Detection();
    ASSERT_TRUE(detection && detection->diagnostics.mirror_camera_from_target);
    EXPECT_EQ(detection->camera_from_target.translation,
              right.location.camera_from_target.translation);
    EXPECT_EQ(detection->diagnostics.mirror_camera_from_target->translation,
              mirror.location.camera_from_target.translation);
    const Eigen::Vector3d away = mirror.location.camera_from_target.translation -
                                 right.location.camera_from_target.translation;
    const Eigen::Matrix3d covariance = detection->covariance.topLeftCorner<3, 3>();
    EXPECT_LT(std::sqrt(away.dot(covariance.ldlt().solve(away))), 5);
    EXPECT_GT(away.norm() / 1e-2, 5) << "in its own covariance it is far off";
  }
}

TEST_F(DetectionChoiceTest, IgnoresMuchWorseMirrorPose) {
  DetectionChoice choice = Choice(0.5);
  PrintFinding right = FindingAt({100, 100}, 8);
  PrintFinding bent = FindingAt({100.5, 100}, 1);
  bent.location.camera_from_target = PrintPose({0.1, 0.02, 5.1}, 0.3, 1 + 3.14, 0.2);
  bent.location.edge_rms_px = 0.1;
  choice.Add(bent);
  choice.Add(right);
  ASSERT_TRUE(choice.Detection());
  EXPECT_EQ(choice.Detection()->center_px, right.center_px);
  EXPECT_FALSE(choice.Detection()->diagnostics.mirror_camera_from_target);
}

// The search ends at a whole print, and at a partial one only where it determines the pose.
TEST_F(DetectionChoiceTest, IsNotSureOfPartWithUncertainPose) {
  DetectionChoice whole = Choice(0.5);
  whole.Add(FindingAt({0, 0}, 2));
  EXPECT_TRUE(whole.IsSure());
  PrintFinding part = FindingAt({0, 0}, 2);
  part.method = DetectionMethod::kPartial;
  part.location.covariance *= 100;  // 0.1 m of 5 m per axis
  DetectionChoice vague = Choice(0.5);
  vague.Add(part);
  EXPECT_FALSE(vague.IsSure());
  EXPECT_TRUE(vague.Detection());
  part.location.covariance *= 1e-3;
  part.log_odds += 1;
  vague.Add(part);
  EXPECT_TRUE(vague.IsSure());
}

}  // namespace
}  // namespace kestrel
