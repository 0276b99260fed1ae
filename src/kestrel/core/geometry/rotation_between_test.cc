// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/geometry/rotation_between.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(RotationBetween, TurnsOneDirectionToOtherByShortestWay) {
  const Eigen::Vector3d from(3, -1, 0.5);
  for (const Eigen::Vector3d& to : {Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(3, -1, 0.5),
                                    Eigen::Vector3d(-3, 1, -0.5), Eigen::Vector3d(-3, 1, -0.51)}) {
    const Eigen::Quaterniond rotation = RotationBetween(from, to);
    EXPECT_NEAR(rotation.norm(), 1, 1e-9);
    EXPECT_LT((rotation * from.normalized() - to.normalized()).norm(), 1e-6);
    EXPECT_NEAR(Eigen::AngleAxisd(rotation).angle(),
                std::acos(std::clamp(from.normalized().dot(to.normalized()), -1.0, 1.0)), 1e-6);
  }
}

}  // namespace
}  // namespace kestrel
