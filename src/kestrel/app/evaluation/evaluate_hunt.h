// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/evaluation/object_comparison.h"
#include "kestrel/app/evaluation/object_results.h"
#include "kestrel/app/evaluation/object_truth.h"
#include "kestrel/app/evaluation/report.h"

namespace kestrel {

// The truth of a recording, and the objects of an output held against it.
struct ComparedHunt {
  ObjectTruth truth;
  ObjectRows rows;
  std::vector<ObjectComparison> comparisons;  // in order of time
};

// Reads object_detections.csv of the folder 'output'. Throws InputError as EvaluateHunt.
ComparedHunt CompareHuntOutput(const std::string& recording, const std::string& output);

// Compares the output of `kestrel hunt` in the folder 'output' (object_detections.csv and, if
// there, object_map.csv) with the truth of 'recording'. Throws InputError when a file is missing or
// not valid, or does not belong to the recording.
Report EvaluateHunt(const std::string& recording, const std::string& output);

}  // namespace kestrel
