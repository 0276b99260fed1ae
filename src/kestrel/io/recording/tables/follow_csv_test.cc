// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/tables/follow_csv.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

long CommasIn(const std::string& row) { return std::count(row.begin(), row.end(), ','); }

TEST(FollowCsvTest, EachRowHasAllColumns) {
  FollowObservation seen;
  seen.time = TimeFromNanoseconds(7);
  seen.region = RegionReport{RegionState::kFollowing, {10, 20, 30, 40}, 0.9};
  const long columns = CommasIn(FollowCsvHeader());
  EXPECT_EQ(CommasIn(UnreadableFollowCsvRow("a", seen.time)), columns);
  EXPECT_EQ(FollowCsvRow("a", seen),
            "a,7,following,10.00,20.00,30.00,40.00,0.9000,,,,,,,,,0.0000\n");
  seen.world_from_camera = RigidTransform{Eigen::Quaterniond::Identity(), {0, 0, 20}};
  seen.place = PlaceOnGround{{0, 30, 0}, Eigen::Vector3d(1, 9, 0).asDiagonal()};
  EXPECT_EQ(FollowCsvRow("a", seen),
            "a,7,following,10.00,20.00,30.00,40.00,0.9000,0.000000,30.000000,0.000000,,,,3.000000,"
            "1.000000,0.0000\n")
      << "the line of sight is along y";
  seen.target.emplace();
  EXPECT_EQ(CommasIn(FollowCsvRow("a", seen)), columns);
  EXPECT_EQ(FollowCsvRow("a", seen, /*only_in_image=*/true),
            "a,7,following,10.00,20.00,30.00,40.00,0.9000,,,,,,,,,0.0000\n");
  seen.region->state = RegionState::kLost;
  EXPECT_EQ(FollowCsvRow("a", seen), "a,7,lost,,,,,0.9000,,,,,,,,,0.0000\n");
}

}  // namespace
}  // namespace kestrel
