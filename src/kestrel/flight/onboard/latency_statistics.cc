// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/latency_statistics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace kestrel {
namespace {

constexpr double kLeast_s = 1e-6;
const double kLogStep = std::log(1.02);

}  // namespace

void LatencyHistogram::Add(Duration latency) {
  const double position = std::log(std::max(ToSeconds(latency), kLeast_s) / kLeast_s) / kLogStep;
  const auto bin = std::min(static_cast<std::size_t>(position), kBins - 1);
  bins_[bin].fetch_add(1, kOrder);
  if (latency.count() > max_ns_.load(kOrder)) max_ns_.store(latency.count(), kOrder);
}

LatencySummary LatencyHistogram::Summary() const {
  std::array<std::uint64_t, kBins> counts;
  LatencySummary summary;
  for (std::size_t i = 0; i < kBins; ++i) {
    counts[i] = bins_[i].load(kOrder);
    summary.count += counts[i];
  }
  summary.dropped = dropped_.load(kOrder);
  if (summary.count == 0) return summary;
  summary.max_s = 1e-9 * static_cast<double>(max_ns_.load(kOrder));
  // Nearest rank; the result is the middle of its bin.
  const auto quantile_s = [&](double part) {
    const auto rank =
        static_cast<std::uint64_t>(std::ceil(part * static_cast<double>(summary.count)));
    std::uint64_t below = 0;
    std::size_t bin = 0;
    while ((below += counts[bin]) < rank) ++bin;
    return std::min(kLeast_s * std::exp((static_cast<double>(bin) + 0.5) * kLogStep),
                    summary.max_s);
  };
  summary.median_s = quantile_s(0.5);
  summary.p99_s = quantile_s(0.99);
  return summary;
}

LatencyStatistics::LatencyStatistics(std::vector<std::string> steps)
    : names_(std::move(steps)), histograms_(names_.size()) {}

std::string LatencyStatistics::InWords() const {
  std::string lines;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const LatencySummary summary = histograms_[i].Summary();
    if (summary.count + summary.dropped == 0) continue;
    lines += fmt::format("{}: median {:.2f} ms, p99 {:.2f}, max {:.2f}; {} of {} dropped\n",
                         names_[i], 1e3 * summary.median_s, 1e3 * summary.p99_s,
                         1e3 * summary.max_s, summary.dropped, summary.count + summary.dropped);
  }
  return lines;
}

}  // namespace kestrel
