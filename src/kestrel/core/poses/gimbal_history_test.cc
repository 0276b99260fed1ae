// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/poses/gimbal_history.h"

#include <chrono>
#include <limits>

#include <gtest/gtest.h>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;

Time AtMs(int ms) { return Time(milliseconds(ms)); }

Eigen::Quaterniond Pitched(double degrees) {
  return RotationBy(Radians(degrees) * Eigen::Vector3d::UnitY());
}

GimbalSample Report(int ms, double pitch_deg, YawFrame frame = YawFrame::kVehicle) {
  return {AtMs(ms), Pitched(pitch_deg), frame};
}

TEST(GimbalHistoryTest, InterpolatesBetweenReports) {
  GimbalHistory history(8);
  history.Add(Report(0, 10));
  history.Add(Report(200, 30));
  const auto attitude = history.At(AtMs(50), {});
  ASSERT_TRUE(attitude);
  EXPECT_LT(attitude->level_from_platform.angularDistance(Pitched(15)), 1e-9);
  EXPECT_EQ(attitude->yaw_frame, YawFrame::kVehicle);
  EXPECT_NEAR(attitude->sigma_rad, 0.5 * 0.05 * 0.15, 1e-9);
  EXPECT_EQ(history.At(AtMs(200), {})->sigma_rad, 0);
}

TEST(GimbalHistoryTest, ContinuesMotionWithGrowingUncertainty) {
  GimbalHistory history(8);
  history.Add(Report(0, 10));
  history.Add(Report(100, 14));
  const auto soon = history.At(AtMs(150), milliseconds(300));
  const auto later = history.At(AtMs(400), milliseconds(300));
  ASSERT_TRUE(soon && later);
  EXPECT_LT(soon->level_from_platform.angularDistance(Pitched(16)), 1e-9);
  EXPECT_LT(later->level_from_platform.angularDistance(Pitched(26)), 1e-9);
  EXPECT_GT(later->sigma_rad, 10 * soon->sigma_rad);
  EXPECT_FALSE(history.At(AtMs(401), milliseconds(300)));
}

TEST(GimbalHistoryTest, HasNoAttitudeBeforeAndBetweenDistantReports) {
  GimbalHistory history(8);
  EXPECT_FALSE(history.At(AtMs(0), milliseconds(100)));
  history.Add(Report(100, 0));
  EXPECT_FALSE(history.At(AtMs(150), milliseconds(100)));  // one report shows no motion
  history.Add(Report(2000, 0));
  EXPECT_FALSE(history.At(AtMs(50), {}));
  EXPECT_FALSE(history.At(AtMs(1000), {}));
}

TEST(GimbalHistoryTest, HasNoAttitudeWhereYawFrameChanges) {
  GimbalHistory history(8);
  history.Add(Report(0, 0, YawFrame::kVehicle));
  history.Add(Report(100, 0, YawFrame::kEarth));
  EXPECT_FALSE(history.At(AtMs(50), {}));
  history.Add(Report(200, 0, YawFrame::kEarth));
  EXPECT_TRUE(history.At(AtMs(150), {}));
}

TEST(GimbalHistoryTest, RejectsInvalidAndOldReports) {
  GimbalHistory history(2);
  EXPECT_EQ(history.Add(Report(100, 0)), PoseStatus::kOk);
  EXPECT_EQ(history.Add(Report(100, 0)), PoseStatus::kOutOfOrder);
  GimbalSample broken = Report(200, 0);
  broken.level_from_platform.w() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(history.Add(broken), PoseStatus::kInvalid);
  broken.level_from_platform = {0, 0, 0, 0};
  EXPECT_EQ(history.Add(broken), PoseStatus::kInvalid);
}

TEST(GimbalHistoryTest, KeepsNewestReports) {
  GimbalHistory history(3);
  for (int i = 0; i < 10; ++i) history.Add(Report(100 * i, i));
  EXPECT_FALSE(history.At(AtMs(650), {}));
  ASSERT_TRUE(history.At(AtMs(750), {}));
  EXPECT_LT(history.At(AtMs(850), {})->level_from_platform.angularDistance(Pitched(8.5)), 1e-9);
}

}  // namespace
}  // namespace kestrel
