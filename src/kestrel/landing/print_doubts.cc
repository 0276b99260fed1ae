// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/print_doubts.h"

#include <algorithm>
#include <cmath>

#include "kestrel/landing/print_score_weights.h"

namespace kestrel {
namespace {

constexpr std::array<std::string_view, kPrintDoubts> kReasons = {
    "an arm of the cross is missing",
    "the arms of the cross are weak",
    "it is dark between the arms of the cross",
    "the ring is broken",
    "the arms of the cross have no edges where they should",
    "the ring has no edges where it should",
    "there are other lines between the arms of the cross",
    "the ring has corners",
    "there is no white board around the ring",
    "there is another figure in the ring",
    "the whole does not look like the print",
    "the gray values are not those of the print",
    "the inside of the ring is not that of the print",
    "the ring is not that of the print",
    "what is around the ring is not white",
    "the edges are not where those of the print are",
    "the edges are not those of a flat print",
    "its position hardly follows from what is seen",
    "it is too small to tell",
    "it is seen too much from the side to tell",
    "too little of it is in view",
    "there are shadows on it",
};

}  // namespace

double LogOddsTakenBy(PrintKind kind, const PrintDoubts& doubts, PrintDoubt doubt) {
  const DoubtWeight& weight =
      kPrintWeights[static_cast<std::size_t>(kind)].doubts[static_cast<std::size_t>(doubt)];
  double taken = 0;
  for (std::size_t i = 0; i < weight.knots.size(); ++i) {
    taken += weight.slopes[i] * std::max(0.0, doubts[doubt] - weight.knots[i]);
  }
  return taken;
}

double PrintLogOdds(PrintKind kind, const PrintDoubts& doubts) {
  double log_odds = kPrintWeights[static_cast<std::size_t>(kind)].certain;
  for (std::size_t i = 0; i < kPrintDoubts; ++i) {
    log_odds -= LogOddsTakenBy(kind, doubts, static_cast<PrintDoubt>(i));
  }
  return log_odds;
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
