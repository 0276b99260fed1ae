// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>

#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/landing/print_finding.h"
#include "kestrel/vision/landing/search_log.h"

namespace kestrel {

// Sees every finding of a search before it is judged.
using FindingObserver = std::function<void(const PrintFinding&)>;

// Of the findings of an image the one that is the pattern most probably, if any is probable enough.
class DetectionChoice {
 public:
  // 'min_quality': least probability. 'observer' may be null; it and the log must outlive this.
  DetectionChoice(double min_quality, const FindingObserver* observer, SearchLog* log);

  // Whether a finding is probable enough to be the pattern.
  bool Accepts(const PrintFinding& finding) const { return finding.log_odds >= least_log_odds_; }

  // Whether it still can be when some of its doubts are not known yet: they only make it less
  // probable.
  bool MayAccept(PrintKind kind, const PrintDoubts& known) const {
    return observer_ || PrintLogOdds(kind, known) >= least_log_odds_;
  }

  // Notes a finding; whether it is accepted.
  bool Add(const PrintFinding& finding);

  // Whether the best so far needs no further search.
  bool IsSure() const { return is_sure_; }

  // The best as it is told. Where the image supports two poses of the same ring alike, the other is
  // told as well, and the covariance is that of both together.
  std::optional<LandingDetection> Detection() const;

 private:
  bool Replaces(const PrintFinding& finding);

  double least_log_odds_;
  const FindingObserver* observer_;
  SearchLog& log_;
  std::optional<PrintFinding> best_;
  std::optional<PrintFinding> mirror_;  // of the best, where it was found too
  bool is_sure_ = false;
};

}  // namespace kestrel
