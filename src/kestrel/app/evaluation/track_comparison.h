// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "kestrel/app/evaluation/landing_results.h"
#include "kestrel/app/evaluation/landing_truth.h"
#include "kestrel/app/evaluation/report_table.h"

namespace kestrel {

// Errors of one row of the track: estimate minus truth, in the world frame.
struct TrackErrors {
  Time time;
  // True height of the camera above the pattern in the newest image not later than 'time'.
  double altitude_m = 0;
  Eigen::Vector3d position;
  Eigen::Vector3d velocity;
  double position_nees = 0;  // with the one standard deviation that holds for all axes
  double velocity_nees = 0;
};

struct PredictionErrors {
  Time time;  // time that it predicts
  Duration horizon{};
  Eigen::Vector3d position;
};

// Rows outside of the known truth and rows in the state "searching" are left out.
std::vector<TrackErrors> CompareTrack(const std::vector<TruePattern>& patterns,
                                      const std::vector<TrackRow>& rows);
std::vector<PredictionErrors> ComparePredictions(const std::vector<TruePattern>& patterns,
                                                 const std::vector<PredictionRow>& rows);

// Returns the errors of position and velocity by altitude, with NEES.
ReportTable TrackTable(std::span<const TrackErrors> errors);

// Returns the errors of the predicted position by horizon.
ReportTable PredictionTable(std::span<const PredictionErrors> errors);

}  // namespace kestrel
