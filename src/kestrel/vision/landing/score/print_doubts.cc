// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/score/print_doubts.h"

#include <algorithm>
#include <cmath>

#include "kestrel/vision/landing/score/print_score_weights.h"

namespace kestrel {
namespace {

constexpr std::array<std::string_view, kPrintDoubts> kReasons = {
    "an arm of the cross is missing",
    "it is dark between the arms of the cross",
    "there is ink between the arms of the cross",
    "there is something in the middle of the cross",
    "there is another line between the arms of the cross",
    "there are other lines between the arms of the cross",
    "there is no white board around the ring",
    "there are lines beyond the ring",
    "ink and white are not where those of the print are",
    "the arms of the cross have no edges where they should",
    "an arm of the cross has no edges where it should",
    "the edges are not where those of the print are",
    "the edges are not those of a flat print",
    "an arm of the cross is faint",
    "the ring is broken",
    "the ring has corners",
    "there is another figure in the ring",
    "the inside of the ring is not that of the print",
    "there are shadows on it",
    "its position hardly follows from what is seen",
    "it is too small to tell",
    "it is seen too much from the side to tell",
    "too little of it is in view",
};

double TakenBy(const DoubtWeight& weight, double doubt) {
  double taken = 0;
  for (std::size_t i = 0; i < weight.knots.size(); ++i) {
    taken += weight.slopes[i] * std::max(0.0, doubt - weight.knots[i]);
  }
  return taken;
}

const PrintWeights& WeightsOf(PrintKind kind) {
  return kPrintWeights[static_cast<std::size_t>(kind)];
}

}  // namespace

double LogOddsTakenBy(PrintKind kind, const PrintDoubts& doubts, PrintDoubt doubt) {
  return TakenBy(WeightsOf(kind).doubts[static_cast<std::size_t>(doubt)], doubts[doubt]);
}

double PrintLogOdds(const PrintWeights& weights, const PrintDoubts& doubts) {
  double log_odds = weights.certain;
  for (std::size_t i = 0; i < kPrintDoubts; ++i) {
    log_odds -= TakenBy(weights.doubts[i], doubts[static_cast<PrintDoubt>(i)]);
  }
  return log_odds;
}

double PrintLogOdds(PrintKind kind, const PrintDoubts& doubts) {
  return PrintLogOdds(WeightsOf(kind), doubts);
}

double ProbabilityOf(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

std::string_view MainDoubt(PrintKind kind, const PrintDoubts& doubts) {
  std::size_t worst = 0;
  double most = -1;
  for (std::size_t i = 0; i < kPrintDoubts; ++i) {
    const double taken = LogOddsTakenBy(kind, doubts, static_cast<PrintDoubt>(i));
    if (taken <= most) continue;
    most = taken;
    worst = i;
  }
  return kReasons[worst];
}

}  // namespace kestrel
