// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/track_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

using ::testing::ElementsAre;

Time At(double seconds) { return Time(DurationFromSeconds(seconds)); }

// A target that moves at 2 m/s along x, seen from a height of 3 m.
std::vector<TruePattern> Straight() {
  std::vector<TruePattern> rows;
  for (int i = 0; i <= 10; ++i) {
    TruePattern row;
    row.time = At(0.1 * i);
    row.world_from_pattern.translation = {0.2 * i, 0, 0};
    row.velocity_in_world = {2, 0, 0};
    row.altitude_m = 3;
    rows.push_back(row);
  }
  return rows;
}

TEST(CompareTrack, MeasuresPositionAndVelocity) {
  const TrackRow row = {At(0.55), "tracking", {1.1, 0.3, 0.4}, {2, 0, 1}, 0.1, 0.5};
  const TrackRow later = {At(3), "lost", {0, 0, 0}, {0, 0, 0}, 1, 1};
  const TrackRow searching = {At(0.5), "searching", {0, 0, 0}, {0, 0, 0}, 1, 1};
  const auto errors = CompareTrack(Straight(), {searching, row, later});
  ASSERT_EQ(errors.size(), 1u);  // the truth ends after a second
  EXPECT_NEAR(errors[0].position.norm(), 0.5, 1e-9);
  EXPECT_NEAR(errors[0].velocity.norm(), 1, 1e-9);
  EXPECT_NEAR(errors[0].position_nees, 25, 1e-6);
  EXPECT_NEAR(errors[0].velocity_nees, 4, 1e-6);
  EXPECT_EQ(errors[0].altitude_m, 3);
  EXPECT_THAT(TrackTable(errors).rows[0],
              ElementsAre("2 to 6", "1", "0.500", "0.500", "1.000", "1.000", "25.00", "4.00"));
}

TEST(ComparePredictions, ComparesWithTruthAtPredictedTime) {
  const Duration half = DurationFromSeconds(0.5);
  const auto errors =
      ComparePredictions(Straight(), {{At(0.2), half, {1.4, 0.1, 0}}, {At(0.8), half, {0, 0, 0}}});
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].time, At(0.7));
  EXPECT_NEAR(errors[0].position.norm(), 0.1, 1e-9);
  EXPECT_THAT(PredictionTable(errors).rows,
              ElementsAre(ElementsAre("0.5", "1", "0.100", "0.100", "0.100")));
}

}  // namespace
}  // namespace kestrel
