// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/pipeline/calibration_monitor.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

// The value that half of the weight lies below.
double WeightedMedian(std::vector<WeightedValue> values) {
  std::ranges::sort(values, {}, &WeightedValue::value);
  double half = 0;
  for (const WeightedValue& each : values) half += 0.5 * each.weight;
  auto it = values.begin();
  for (; it + 1 != values.end() && half >= it->weight; ++it) half -= it->weight;
  return it->value;
}

}  // namespace

void CalibrationMonitor::Add(const CalibrationEvidence& evidence) {
  // What one expects of any calibration is in every view's estimate. It is taken out: it would
  // count with each of them.
  const double expected_sigma = CalibrationEvidence().log_focal_sigma;
  const double of_view = 1 - std::pow(evidence.log_focal_sigma / expected_sigma, 2);
  const double variance = std::pow(evidence.log_focal_sigma, 2) / of_view;
  if (!(of_view > 0 && variance > 0 && variance < kMaxSigma * kMaxSigma)) return;
  views_.push_back({evidence.log_focal / of_view, 1 / (variance + kSharedSigma * kSharedSigma)});
}

std::optional<FocalFactor> CalibrationMonitor::Focal() const {
  if (views_.size() < kMinViews) return std::nullopt;
  const double log_focal = WeightedMedian(views_);
  std::vector<WeightedValue> deviations = views_;
  double weights = 0;
  double squared_weights = 0;
  for (WeightedValue& each : deviations) {
    each.value = std::abs(each.value - log_focal);
    weights += each.weight;
    squared_weights += each.weight * each.weight;
  }
  // By the views' own standard deviations, or by how far they scatter where that is more.
  const double told_variance = 1 / weights;
  const double scatter = kSigmaOfDeviation * WeightedMedian(std::move(deviations));
  const double seen_variance = scatter * scatter * squared_weights / (weights * weights);
  const double sigma =
      std::hypot(kSharedSigma, kSigmaOfMedian * std::sqrt(std::max(told_variance, seen_variance)));
  const double factor = std::exp(log_focal);
  return FocalFactor{factor, factor * sigma, views_.size()};
}

std::optional<FocalFactor> CalibrationMonitor::Contradiction() const {
  const std::optional<FocalFactor> focal = Focal();
  if (!focal) return std::nullopt;
  const double difference = std::abs(focal->factor - 1);
  const bool contradicts = difference > std::max(kLeastContradiction, kSureSigmas * focal->sigma);
  return contradicts ? focal : std::nullopt;
}

}  // namespace kestrel
