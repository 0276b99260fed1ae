// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "kestrel/app/evaluation/landing_results.h"
#include "kestrel/app/evaluation/landing_truth.h"
#include "kestrel/app/evaluation/report_table.h"

namespace kestrel {

// Errors of a row of the track in the world, estimate minus truth.
struct TrackErrors {
  Time time;
  double altitude_m = 0;  // of the camera above the pattern, at the last image before
  Eigen::Vector3d position;
  Eigen::Vector3d velocity;
  double position_nees = 0;  // against the standard deviation that all axes are given
  double velocity_nees = 0;
};

struct PredictionErrors {
  Time time;  // for which it was made
  Duration horizon{};
  Eigen::Vector3d position;
};

// Rows for whose time the truth is not known are left out, and those of a track that is not yet
// one.
std::vector<TrackErrors> CompareTrack(const std::vector<TruePattern>& patterns,
                                      const std::vector<TrackRow>& rows);
std::vector<PredictionErrors> ComparePredictions(const std::vector<TruePattern>& patterns,
                                                 const std::vector<PredictionRow>& rows);

// Errors of position and velocity by altitude, with NEES.
ReportTable TrackTable(std::span<const TrackErrors> errors);

// Errors of the predicted position by horizon.
ReportTable PredictionTable(std::span<const PredictionErrors> errors);

}  // namespace kestrel
