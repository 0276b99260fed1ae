// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/mount/pose_smoothing.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

constexpr Duration kWindow = std::chrono::milliseconds(100);

Eigen::Quaterniond Turn(const Eigen::Vector3d& axis, double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
}

RigidTransform PoseAt(double t) {
  return {Turn(Eigen::Vector3d::UnitZ(), 1.5 * t) *
              Turn(Eigen::Vector3d::UnitX(), 0.5 * std::sin(3 * t)),
          {2 * std::sin(2 * t), t * t, 3 - t}};
}

std::vector<PoseSample> Samples(double noise) {
  Random random(1);
  const auto vector = [&] {
    const double x = random.Normal();
    const double y = random.Normal();
    return Eigen::Vector3d(noise * Eigen::Vector3d(x, y, random.Normal()));
  };
  std::vector<PoseSample> samples;
  for (int i = 0; i < 300; ++i) {
    RigidTransform pose = PoseAt(i / 100.0);
    pose.translation += vector();
    const Eigen::Vector3d turn = vector();
    if (noise > 0) pose.rotation = pose.rotation * Turn(turn.normalized(), turn.norm());
    samples.push_back({Time(DurationFromSeconds(i / 100.0)), pose});
  }
  return samples;
}

struct Rms {
  double position = 0;
  double rotation = 0;
};
Rms ErrorsOf(const std::vector<PoseSample>& samples) {
  Rms rms;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const RigidTransform truth = PoseAt(static_cast<double>(i) / 100);
    rms.position += (samples[i].world_from_body.translation - truth.translation).squaredNorm();
    rms.rotation +=
        std::pow(samples[i].world_from_body.rotation.angularDistance(truth.rotation), 2);
  }
  const auto count = static_cast<double>(samples.size());
  return {std::sqrt(rms.position / count), std::sqrt(rms.rotation / count)};
}

TEST(SmoothPoses, MoreThanHalvesNoise) {
  const std::vector<PoseSample> noisy = Samples(0.01);
  const Rms before = ErrorsOf(noisy);
  const Rms after = ErrorsOf(SmoothPoses(noisy, kWindow));
  EXPECT_LT(after.position, 0.45 * before.position);
  EXPECT_LT(after.rotation, 0.45 * before.rotation);
}

TEST(SmoothPoses, PreservesMotion) {
  const Rms rms = ErrorsOf(SmoothPoses(Samples(0), kWindow));
  EXPECT_LT(rms.position, 1e-3);
  EXPECT_LT(rms.rotation, 1e-3);
}

TEST(SmoothPoses, LeavesFewSamplesUnchanged) {
  std::vector<PoseSample> few = Samples(0.01);
  few.resize(5);
  const std::vector<PoseSample> smooth = SmoothPoses(few, kWindow);
  ASSERT_EQ(smooth.size(), few.size());
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(smooth[i].time, few[i].time);
    EXPECT_EQ(smooth[i].world_from_body.translation, few[i].world_from_body.translation);
  }
  EXPECT_TRUE(SmoothPoses({}, kWindow).empty());
}

}  // namespace
}  // namespace kestrel
