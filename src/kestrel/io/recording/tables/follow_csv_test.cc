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
  const long columns = CommasIn(FollowCsvHeader());
  EXPECT_EQ(CommasIn(FollowCsvRow("a", seen)), columns) << "before the mark";
  EXPECT_EQ(CommasIn(UnreadableFollowCsvRow("a", seen.time)), columns);
  seen.region = RegionReport{RegionState::kFollowing, {10, 20, 30, 40}, 0.9};
  seen.bearing = Eigen::Vector3d(0, 0.6, -0.8);
  seen.place = PlaceOnGround{{1, 2, 0}, Eigen::Matrix3d::Identity() * 4};
  seen.track_state = TrackState::kTracking;
  seen.target.emplace();
  const std::string row = FollowCsvRow("a", seen);
  EXPECT_EQ(CommasIn(row), columns);
  EXPECT_EQ(row.rfind("a,7,following,10.00,20.00,30.00,40.00,0.900,0.000000,0.600000,-0.800000,"
                      "1.000000,2.000000,0.000000,2.000000,2.000000,2.000000,tracking,",
                      0),
            0u)
      << row;
}

}  // namespace
}  // namespace kestrel
