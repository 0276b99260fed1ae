// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace kestrel {
namespace {

constexpr double kNormal975 = 1.959963984540054;  // 97.5 % quantile of the standard normal
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Interval WilsonInterval(int successes, int trials) {
  if (trials == 0) return {0, 1};
  constexpr double kZ2 = kNormal975 * kNormal975;
  const double n = trials;
  const double share = successes / n;
  const double center = (share + kZ2 / (2 * n)) / (1 + kZ2 / n);
  const double half =
      kNormal975 / (1 + kZ2 / n) * std::sqrt(share * (1 - share) / n + kZ2 / (4 * n * n));
  return {std::max(0.0, center - half), std::min(1.0, center + half)};
}

Interval ChiSquareBounds(int degrees) {
  const double variance = 2 / (9.0 * degrees);
  const auto quantile = [&](double z) {
    return degrees * std::pow(std::max(0.0, 1 - variance + z * std::sqrt(variance)), 3);
  };
  return {quantile(-kNormal975), quantile(kNormal975)};
}

Interval MeanNeesBounds(int count, int dimensions) {
  const Interval sum = ChiSquareBounds(count * dimensions);
  return {sum.low / count, sum.high / count};
}

int IndependentCount(std::span<const double> series) {
  const auto count = static_cast<double>(series.size());
  const double mean = Mean(series);
  double squares = 0, products = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    squares += (series[i] - mean) * (series[i] - mean);
    if (i > 0) products += (series[i] - mean) * (series[i - 1] - mean);
  }
  const double correlation = squares > 0 ? std::clamp(products / squares, 0.0, 1.0) : 0.0;
  return std::max(1, static_cast<int>(count * (1 - correlation) / (1 + correlation)));
}

double Mean(std::span<const double> values) {
  if (values.empty()) return kNaN;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double RootMeanSquare(std::span<const double> values) {
  if (values.empty()) return kNaN;
  return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) /
                   static_cast<double>(values.size()));
}

double Quantile(std::vector<double> values, double part) {
  if (values.empty()) return kNaN;
  std::sort(values.begin(), values.end());
  const double rank = part * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], rank - static_cast<double>(below));
}

}  // namespace kestrel
