// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>

#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/landing/score/print_finding.h"
#include "kestrel/vision/target/search_log.h"

namespace kestrel {

// Called with every finding of a search, before it is judged.
using FindingObserver = std::function<void(const PrintFinding&)>;

// Chooses the finding of an image that is most probably the pattern, if any is probable enough.
class DetectionChoice {
 public:
  // 'min_quality': least accepted probability, 0 to 1. 'observer' may be null. Observer and log
  // must outlive this.
  DetectionChoice(double min_quality, const FindingObserver* observer, SearchLog* log);

  // True when a finding is probable enough to be the pattern.
  bool Accepts(const PrintFinding& finding) const { return finding.log_odds >= least_log_odds_; }

  // True when a finding may still be accepted although only the doubts in 'known' are measured.
  // Further doubts can only lower the probability. Always true with an observer.
  bool MayAccept(PrintKind kind, const PrintDoubts& known) const {
    return observer_ || PrintLogOdds(kind, known) >= least_log_odds_;
  }

  // Adds a finding. True when it is accepted.
  bool Add(const PrintFinding& finding);

  // True when the best finding so far is so probable that another start of its alignment would not
  // improve it.
  bool IsClear() const;

  // True when the best finding so far needs no further search.
  bool IsSure() const { return is_sure_; }

  // Returns the best finding as a detection. When the image supports both mirror poses of one ring,
  // it includes the other pose too, and the covariance covers both.
  std::optional<TargetDetection> Detection() const;

 private:
  bool Replaces(const PrintFinding& finding);

  double least_log_odds_;
  const FindingObserver* observer_;
  SearchLog& log_;
  std::optional<PrintFinding> best_;
  std::optional<PrintFinding> mirror_;  // mirror pose of the best finding, if it was found too
  bool is_sure_ = false;
};

}  // namespace kestrel
