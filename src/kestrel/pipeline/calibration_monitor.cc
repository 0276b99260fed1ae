// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/pipeline/calibration_monitor.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

constexpr std::size_t kMinViews = 10;
constexpr double kSureSigmas = 3;
constexpr double kLeastContradiction = 0.015;
// Largest standard deviation of a view that says something.
constexpr double kMaxSigma = 0.1;
// What detections have in common, such as a sheet that is not flat.
constexpr double kSharedSigma = 0.003;
// Of a normal distribution: its standard deviation as a factor of the median deviation, and the
// standard deviation of a median as a factor of that of a mean.
constexpr double kSigmaOfDeviation = 1.4826;
constexpr double kSigmaOfMedian = 1.2533;

constexpr double kBinWidth = 0.001;

}  // namespace

void CalibrationMonitor::Add(const CalibrationEvidence& evidence) {
  // What one expects of any calibration is in every view's estimate. It is taken out: it would
  // count with each of them.
  const double expected_sigma = CalibrationEvidence().log_focal_sigma;
  const double of_view = 1 - std::pow(evidence.log_focal_sigma / expected_sigma, 2);
  const double variance = std::pow(evidence.log_focal_sigma, 2) / of_view;
  if (!(of_view > 0 && variance > 0 && variance < kMaxSigma * kMaxSigma)) return;
  const double weight = 1 / (variance + kSharedSigma * kSharedSigma);
  const double bin = std::round(evidence.log_focal / of_view / kBinWidth) + kMiddleBin;
  if (!std::isfinite(bin)) return;
  weights_[static_cast<int>(std::clamp(bin, 0.0, kBins - 1.0))] += weight;
  weight_ += weight;
  squared_weights_ += weight * weight;
  ++views_;
}

// The bin that half of the weight lies below.
int CalibrationMonitor::MedianBin() const {
  int bin = 0;
  for (double below = weights_[0]; below < 0.5 * weight_ && bin + 1 < kBins;) {
    below += weights_[++bin];
  }
  return bin;
}

double CalibrationMonitor::MedianDeviation(int from_bin) const {
  const auto weight_of = [&](int bin) { return bin >= 0 && bin < kBins ? weights_[bin] : 0; };
  int reach = 0;
  for (double within = weights_[from_bin]; within < 0.5 * weight_ && reach < kBins;) {
    ++reach;
    within += weight_of(from_bin - reach) + weight_of(from_bin + reach);
  }
  return kBinWidth * reach;
}

std::optional<FocalFactor> CalibrationMonitor::Focal() const {
  if (views_ < kMinViews) return std::nullopt;
  const int median = MedianBin();
  // By the views' own standard deviations, or by how far they scatter where that is more.
  const double told_variance = 1 / weight_;
  const double scatter = kSigmaOfDeviation * MedianDeviation(median);
  const double seen_variance = scatter * scatter * squared_weights_ / (weight_ * weight_);
  const double sigma =
      std::hypot(kSharedSigma, kSigmaOfMedian * std::sqrt(std::max(told_variance, seen_variance)));
  const double log_focal = kBinWidth * (median - kMiddleBin);
  const double factor = std::exp(log_focal);
  return FocalFactor{factor, factor * sigma, views_};
}

std::optional<FocalFactor> CalibrationMonitor::Contradiction() const {
  const std::optional<FocalFactor> focal = Focal();
  if (!focal) return std::nullopt;
  const double difference = std::abs(focal->factor - 1);
  const bool contradicts = difference > std::max(kLeastContradiction, kSureSigmas * focal->sigma);
  return contradicts ? focal : std::nullopt;
}

}  // namespace kestrel
