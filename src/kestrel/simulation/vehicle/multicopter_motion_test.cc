// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/vehicle/multicopter_motion.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

using Eigen::Vector3d;

TEST(MulticopterMotionTest, ThrustPointsAlongAcceleration) {
  Random random(1);
  const Path path = [](double time_s) { return Vector3d(0.5 * 4 * time_s * time_s, 0, 5); };
  const Motion motion = MulticopterMotion(
      path, [](double) { return 0.7; }, 0, &random);
  const RigidTransform pose = motion(1);
  EXPECT_LT(((pose.rotation * Vector3d::UnitZ()) - Vector3d(4, 0, 9.81).normalized()).norm(), 1e-4);
  const Vector3d forward = pose.rotation * Vector3d::UnitX();
  EXPECT_GT(forward.head<2>().normalized().dot(Eigen::Vector2d(std::cos(0.7), std::sin(0.7))),
            0.95);
}

}  // namespace
}  // namespace kestrel
