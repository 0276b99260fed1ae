// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/vehicle_motion.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

using Eigen::Vector3d;

TEST(VehicleMotionTest, VehicleKeepsItsSpeedAndLooksAhead) {
  for (const char* path : {"straight", "circle", "figure8"}) {
    Random random(5);
    VehicleMotionOptions options;
    options.path = path;
    options.speed_mps = 8.3;
    const Motion motion = VehicleMotion(options, &random);
    for (double time_s = 0; time_s < 20; time_s += 0.5) {
      const Vector3d velocity = VelocityOf(motion, time_s);
      ASSERT_NEAR(velocity.norm(), 8.3, 0.4) << path;
      ASSERT_GT((motion(time_s).rotation * Vector3d::UnitX()).dot(velocity.normalized()), 0.999);
    }
  }
}

TEST(VehicleMotionTest, RefusesBadOptionsInWords) {
  VehicleMotionOptions vehicle;
  vehicle.path = "spiral";
  EXPECT_EQ(vehicle.Validate().at(0),
            "path is 'spiral', expected standing, straight, circle or figure8");
}

}  // namespace
}  // namespace kestrel
