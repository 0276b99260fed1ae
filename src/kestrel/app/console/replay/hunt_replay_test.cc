// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/hunt_replay.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(StandingObjectsTest, MapHasStandingObjectsOnly) {
  const std::string map =
      "id,class,score,p_x_m,p_y_m,p_z_m,v_x_mps,v_y_mps,v_z_mps,sigma_m,detections,first_seen_ns,"
      "last_seen_ns,moving,shape,digit,digit_probability\n"
      "1,red,5,1.5,2.5,0,0,0,0,0.5,4,1000,9000,0,disc,,\n"
      "2,yellow,5,7,8,0,1,0,0,0.1,4,1000,9000,1,disc,,\n";
  const std::vector<MapEntry> entries = StandingObjects(map, "object_map.csv");
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_EQ(entries[0].since, TimeFromNanoseconds(1000));
  EXPECT_EQ(entries[0].object.label, "red");
  EXPECT_EQ(entries[0].object.position, Eigen::Vector2d(1.5, 2.5));
  EXPECT_EQ(entries[0].object.covariance(0, 0), 0.25);
}

}  // namespace
}  // namespace kestrel
