// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/poses/pose_history.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

constexpr Duration kMaxGap = std::chrono::seconds(1);

Time At(double seconds) { return Time(DurationFromSeconds(seconds)); }

PoseSample Sample(double seconds, double x, double yaw = 0) {
  return {At(seconds),
          {Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())), {x, 0, 0}}};
}

TEST(PoseHistory, EmptyHistoryHasNoPose) {
  const PoseHistory history(4, kMaxGap);
  EXPECT_FALSE(history.Has(At(0)));
}

TEST(PoseHistory, AnswersWithinSamplesOnly) {
  PoseHistory history(4, kMaxGap);
  history.Add(Sample(1.0, 1));
  history.Add(Sample(2.0, 2));
  EXPECT_FALSE(history.Has(At(0.999)));
  EXPECT_TRUE(history.Has(At(1.0)));
  EXPECT_TRUE(history.Has(At(1.5)));
  EXPECT_TRUE(history.Has(At(2.0)));
  EXPECT_FALSE(history.Has(At(2.001)));
}

TEST(PoseHistory, InterpolatesLineAndShortestArc) {
  PoseHistory history(4, kMaxGap);
  PoseSample from = Sample(0, 10, -0.2);
  PoseSample to = Sample(1, 14, 0.6);
  to.world_from_body.rotation.coeffs() *= -1;  // the same rotation by the opposite quaternion
  history.Add(from);
  history.Add(to);
  const auto pose = history.Lookup(At(0.25));
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->translation.x(), 11, 1e-12);
  const Eigen::Vector3d x_axis = pose->rotation * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(std::atan2(x_axis.y(), x_axis.x()), 0.0, 1e-12);
}

TEST(PoseHistory, DropsOldestWhenFull) {
  PoseHistory history(3, kMaxGap);
  for (int i = 0; i < 8; ++i) {
    ASSERT_EQ(history.Add(Sample(0.1 * i, i)), PoseStatus::kOk);
    EXPECT_LE(history.size(), 3u);
  }
  EXPECT_FALSE(history.Has(At(0.4)));
  for (int i = 5; i < 8; ++i) {
    const auto pose = history.Lookup(At(0.1 * i));
    ASSERT_TRUE(pose) << i;
    EXPECT_EQ(pose->translation.x(), i);
  }
  EXPECT_NEAR(history.Lookup(At(0.65))->translation.x(), 6.5, 1e-9);
}

TEST(PoseHistory, RefusesOutOfOrderPose) {
  PoseHistory history(4, kMaxGap);
  history.Add(Sample(1.0, 1));
  EXPECT_EQ(history.Add(Sample(1.0, 5)), PoseStatus::kOutOfOrder);
  EXPECT_EQ(history.Add(Sample(0.5, 5)), PoseStatus::kOutOfOrder);
  EXPECT_EQ(history.size(), 1u);
  EXPECT_EQ(history.Lookup(At(1.0))->translation.x(), 1);
}

TEST(PoseHistory, RefusesInvalidPose) {
  PoseHistory history(4, kMaxGap);
  PoseSample sample = Sample(1.0, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(history.Add(sample), PoseStatus::kInvalid);
  sample = Sample(1.0, std::numeric_limits<double>::infinity());
  EXPECT_EQ(history.Add(sample), PoseStatus::kInvalid);
  sample = Sample(1.0, 0);
  sample.world_from_body.rotation.coeffs().setZero();
  EXPECT_EQ(history.Add(sample), PoseStatus::kInvalid);
  sample.world_from_body.rotation.w() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(history.Add(sample), PoseStatus::kInvalid);
  EXPECT_EQ(history.size(), 0u);
}

TEST(PoseHistory, ReportsWhyPoseIsMissing) {
  PoseHistory history(3, kMaxGap);
  EXPECT_EQ(history.Check(At(0)), PoseLookup::kEmpty);
  for (const double seconds : {0.0, 1.0, 1.5, 3.0}) history.Add(Sample(seconds, 0));
  EXPECT_EQ(history.Check(At(0.9)), PoseLookup::kTooOld);
  EXPECT_EQ(history.Check(At(1.2)), PoseLookup::kFound);
  EXPECT_EQ(history.Check(At(2)), PoseLookup::kGap);
  EXPECT_EQ(history.Check(At(3)), PoseLookup::kFound);
  EXPECT_EQ(history.Check(At(3.1)), PoseLookup::kTooNew);
}

TEST(PoseHistory, DoesNotBridgeGap) {
  PoseHistory history(4, kMaxGap);
  history.Add(Sample(0, 0));
  history.Add(Sample(1.5, 1));
  EXPECT_TRUE(history.Has(At(0)));
  EXPECT_TRUE(history.Has(At(1.5)));
  EXPECT_FALSE(history.Has(At(0.1)));
}

TEST(PoseHistory, SmoothPosesHaveLessNoiseAndNoDelay) {
  Random random(1);
  PoseHistory history(2000, kMaxGap);
  double lookup = 0;
  double smooth = 0;
  // 3 m/s and 0.5 rad/s at 100 Hz; each pose is used as it arrives.
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.01 * i;
    history.Add(Sample(t, 3 * t + 0.01 * random.Normal(), 0.5 * t + 0.003 * random.Normal()));
    if (i < 20) continue;
    const Time now = At(t - 0.002);
    const RigidTransform truth =
        Sample(t - 0.002, 3 * (t - 0.002), 0.5 * (t - 0.002)).world_from_body;
    const auto error = [&](const RigidTransform& pose) {
      return std::pow(pose.translation.x() - truth.translation.x(), 2) +
             std::pow(pose.rotation.angularDistance(truth.rotation), 2);
    };
    lookup += error(*history.Lookup(now));
    smooth += error(*history.Smooth(now, std::chrono::milliseconds(100)));
  }
  EXPECT_LT(smooth, 0.5 * lookup);
}

TEST(PoseHistory, TooFewPosesAreNotSmoothed) {
  PoseHistory history(10, kMaxGap);
  for (int i = 0; i < 8; ++i) history.Add(Sample(0.1 * i, i % 2));
  const Duration half_window = std::chrono::milliseconds(120);
  EXPECT_EQ(history.Smooth(At(0.4), half_window)->translation.x(), 0);
  EXPECT_FALSE(history.Smooth(At(0.75), half_window));
}

constexpr Duration kAhead = std::chrono::milliseconds(100);

TEST(PoseHistory, PredictsByMotionOfNewestSample) {
  PoseHistory history(4, kMaxGap);
  PoseSample sample = Sample(1, 10, 0.5);
  sample.motion = BodyMotion{{2, 0, -1}, {0, 0, 3}};
  history.Add(Sample(0.9, 0));
  history.Add(sample);
  const auto pose = history.Predict(At(1.1), kAhead, {});
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->world_from_body.translation.x(), 10.2, 1e-9);
  EXPECT_NEAR(pose->world_from_body.translation.z(), -0.1, 1e-9);
  EXPECT_NEAR(RotationVector(pose->world_from_body.rotation).z(), 0.8, 1e-9);
  EXPECT_FALSE(history.Predict(At(1.101), kAhead, {}));
}

// The deck turns a UAV that touches down upright at once.
TEST(PoseHistory, DoesNotExtrapolateTouchDownShock) {
  PoseHistory history(10, kMaxGap);
  PoseSample sample = Sample(1, 0);
  sample.motion = BodyMotion{{0, 0, -0.7}, {30, 0, 0}};
  history.Add(sample);
  const auto pose = history.Predict(At(1.05), kAhead, {});
  const Eigen::Quaterniond& before = sample.world_from_body.rotation;
  EXPECT_NEAR(before.angularDistance(pose->world_from_body.rotation), 0.2, 1e-9);
}

TEST(PoseHistory, UncertaintyGrowsWithPrediction) {
  PoseHistory history(4, kMaxGap);
  PoseSample sample = Sample(1, 10);
  sample.motion = BodyMotion{};
  history.Add(Sample(0.9, 10));
  history.Add(sample);
  const UnmodelledMotion unmodelled{.acceleration_mps2 = 3,
                                    .angular_acceleration_radps2 = 8,
                                    .velocity_sigma_mps = 0,
                                    .rate_sigma_radps = 0};
  const PoseUncertainty between = history.Predict(At(0.95), kAhead, unmodelled)->uncertainty;
  EXPECT_EQ(between.position_m, 0);
  EXPECT_EQ(between.attitude_rad, 0);
  const PoseUncertainty ahead = history.Predict(At(1.1), kAhead, unmodelled)->uncertainty;
  EXPECT_NEAR(ahead.position_m, 0.015, 1e-9);
  EXPECT_NEAR(ahead.attitude_rad, 0.04, 1e-9);
  UnmodelledMotion noisy = unmodelled;
  noisy.velocity_sigma_mps = 0.2;
  EXPECT_NEAR(history.Predict(At(1.1), kAhead, noisy)->uncertainty.position_m, 0.025, 1e-9);
}

TEST(PoseHistory, PredictsFromLastSamplesWithoutGivenMotion) {
  PoseHistory history(10, kMaxGap);
  history.Add(Sample(0.99, 0.99 * 4, 0.99));
  EXPECT_FALSE(history.Predict(At(1), kAhead, {})) << "one sample has no motion";
  for (int i = 0; i <= 6; ++i) {
    const double t = 1 + 0.01 * i;
    history.Add(Sample(t, 4 * t, t));
  }
  const auto pose = history.Predict(At(1.09), kAhead, {});
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->world_from_body.translation.x(), 4 * 1.09, 1e-9);
  EXPECT_NEAR(RotationVector(pose->world_from_body.rotation).z(), 1.09, 1e-9);
  PoseSample reported = Sample(1.07, 4 * 1.07, 1.07);
  reported.motion = BodyMotion{{4, 0, 0}, {0, 0, 1}};
  history.Add(reported);
  EXPECT_LT(history.Predict(At(1.1), kAhead, {})->uncertainty.position_m,
            pose->uncertainty.position_m)
      << "a motion that is told is newer than a mean one";
}

TEST(PoseHistory, AccelerationIsChangeOfReportedVelocity) {
  PoseHistory history(100, kMaxGap);
  EXPECT_EQ(history.Acceleration(), Eigen::Vector3d(0, 0, 0));
  for (int i = 0; i <= 50; ++i) {
    PoseSample sample = Sample(0.02 * i, 0);
    const double braked_s = std::max(0.02 * i - 0.5, 0.0);  // begins to brake halfway
    sample.motion = BodyMotion{{4 - 3 * braked_s, 0, 0}, {0, 0, 0}};
    history.Add(sample);
  }
  EXPECT_NEAR(history.Acceleration().x(), -3, 1e-9);
  history.Add(Sample(1.02, 0));  // no motion given
  EXPECT_EQ(history.Acceleration(), Eigen::Vector3d(0, 0, 0));
}

TEST(PoseHistory, RefusesNonFiniteMotion) {
  PoseHistory history(4, kMaxGap);
  PoseSample sample = Sample(1, 0);
  sample.motion = BodyMotion{{0, std::numeric_limits<double>::quiet_NaN(), 0}, {0, 0, 0}};
  EXPECT_EQ(history.Add(sample), PoseStatus::kInvalid);
}

}  // namespace
}  // namespace kestrel
