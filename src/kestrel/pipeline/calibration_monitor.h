// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "kestrel/landing/calibration_evidence.h"

namespace kestrel {

// The focal length as a factor of the calibration's.
struct FocalFactor {
  double factor;
  double sigma;            // standard deviation
  std::size_t detections;  // how many say so
};

// Keeps count of what the detections of a run say about the calibration's focal length. Does not
// allocate, however long the run is.
class CalibrationMonitor {
 public:
  // Views that say nothing of the focal length are left out.
  void Add(const CalibrationEvidence& evidence);

  // What the detections say together; nothing where there are too few of them.
  std::optional<FocalFactor> Focal() const;

  // The same, where it contradicts the calibration.
  std::optional<FocalFactor> Contradiction() const;

 private:
  static constexpr int kMiddleBin = 500;            // the one around 0
  static constexpr int kBins = 2 * kMiddleBin + 1;  // of 0.1 %

  int MedianBin() const;
  double MedianDeviation(int from_bin) const;

  // Of the views, by the logarithm of the factor: sum of the inverse variances.
  std::array<double, kBins> weights_{};
  double weight_ = 0;           // of all
  double squared_weights_ = 0;  // of all views, their sum
  std::size_t views_ = 0;
};

}  // namespace kestrel
