// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/evaluation/flight_truth.h"
#include "kestrel/app/evaluation/landing_comparison.h"
#include "kestrel/app/evaluation/report.h"

namespace kestrel {

// The truth of a recording, and each image of an output held against it.
struct ComparedLanding {
  FlightTruth flight;
  std::vector<TruePattern> patterns;
  std::vector<LandingComparison> comparisons;  // one per row of landing_detections.csv, in order
};

// Reads landing_detections.csv of the folder 'output'. Throws InputError as EvaluateLanding.
ComparedLanding CompareLandingOutput(const std::string& recording, const std::string& output);

// Compares the output of `kestrel land` in the folder 'output' (landing_detections.csv and, if
// there, landing_track.csv and landing_prediction.csv) with the truth of 'recording'. Throws
// InputError when a file is missing or not valid, or does not belong to the recording.
Report EvaluateLanding(const std::string& recording, const std::string& output);

}  // namespace kestrel
