// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "kestrel/app/evaluation/landing_comparison.h"
#include "kestrel/app/evaluation/plot.h"
#include "kestrel/app/evaluation/track_comparison.h"

namespace kestrel {

// All comparisons of one flight; times in the plots count from 'start'.
struct LandingPlotData {
  Time start;
  std::span<const TruePattern> patterns;
  std::span<const LandingComparison> comparisons;
  std::span<const TrackRow> track;  // empty without a track
  std::span<const TrackErrors> track_errors;
  std::span<const PredictionErrors> prediction_errors;
};

// Returns the plots of the paper's figure 11: true and estimated position of the target over time
// and in the plane, and the errors; also the rate by altitude, the NEES over time and, if there is
// a track, velocity and prediction. Plots without data are left out.
std::vector<Plot> LandingPlots(const LandingPlotData& data);

}  // namespace kestrel
