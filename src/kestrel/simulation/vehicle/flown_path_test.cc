// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/vehicle/flown_path.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

RigidTransform Turned(double angle, const Vector3d& place) {
  return {Quaterniond(AngleAxisd(angle, Vector3d::UnitZ())), place};
}

TEST(FlownPathTest, InterpolatesAndHoldsEnds) {
  FlownPath path(1, 0.5);
  path.Add(Turned(0, {0, 0, 0}));
  EXPECT_EQ(path.At(7).translation, Vector3d(0, 0, 0)) << "a single pose";
  path.Add(Turned(0.2, {1, 0, 0}));
  path.Add(Turned(0.4, {1, 2, 0}));
  EXPECT_EQ(path.end_s(), 2);
  const RigidTransform between = path.At(1.75);
  EXPECT_LT((between.translation - Vector3d(1, 1, 0)).norm(), 1e-12);
  EXPECT_LT(between.rotation.angularDistance(Turned(0.3, {}).rotation), 1e-12);
  EXPECT_EQ(path.At(0).translation, Vector3d(0, 0, 0));
  EXPECT_EQ(path.At(9).translation, Vector3d(1, 2, 0));
}

}  // namespace
}  // namespace kestrel
