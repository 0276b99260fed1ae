// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "kestrel/landing/calibration_evidence.h"

namespace kestrel {

struct WeightedValue {
  double value;
  double weight;
};

// The focal length as a factor of the calibration's.
struct FocalFactor {
  double factor;
  double sigma;            // standard deviation
  std::size_t detections;  // how many say so
};

// Keeps count of what the detections of a run say about the calibration's focal length.
class CalibrationMonitor {
 public:
  // Views that say nothing of the focal length are left out.
  void Add(const CalibrationEvidence& evidence);

  // What the detections say together; nothing where there are too few of them.
  std::optional<FocalFactor> Focal() const;

  // The same, where it contradicts the calibration.
  std::optional<FocalFactor> Contradiction() const;

 private:
  std::vector<WeightedValue> views_;  // logarithm of the factor, one over its variance
};

}  // namespace kestrel
