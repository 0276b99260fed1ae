// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/tables/track_csv.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TargetEstimate Target() {
  TargetEstimate target{TimeFromNanoseconds(1'500'000'000), {}};
  target.motion.mean.head<8>() << 1, 2, 3, 0, 4, 0.5, 0.25, 0;
  target.motion.covariance.diagonal().head<6>() << 0.01, 0.01, 0.01, 0.04, 0.04, 0.04;
  return target;
}

TEST(TrackCsv, WritesTarget) {
  LandingObservation observation;
  observation.time = TimeFromNanoseconds(1'500'000'000);
  observation.track_state = TrackState::kPredicting;
  observation.target = Target();
  EXPECT_EQ(TrackCsvRow(observation),
            "1500000000,predicting,1.000000,2.000000,3.000000,0.000000,4.000000,0.500000,1.570796,"
            "0.250000,0.100000,0.200000\n");
}

TEST(TrackCsv, EveryRowIsAsWideAsHeader) {
  const auto commas = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  LandingObservation observation;
  observation.track_state = TrackState::kLost;
  EXPECT_EQ(commas(TrackCsvRow(observation)), commas(TrackCsvHeader()));
  observation.target = Target();
  EXPECT_EQ(commas(TrackCsvRow(observation)), commas(TrackCsvHeader()));
}

TEST(TrackCsv, WritesPrediction) {
  EXPECT_EQ(PredictionCsvRow(TimeFromNanoseconds(1'000'000'000), Target()),
            "1000000000,0.5,1.000000,2.000000,3.000000\n");
  EXPECT_EQ(PredictionCsvHeader(), "timestamp_ns,horizon_s,p_x_m,p_y_m,p_z_m\n");
}

}  // namespace
}  // namespace kestrel
