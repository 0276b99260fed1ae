// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/score/print_doubts.h"

#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

constexpr PrintKind kKinds[] = {PrintKind::kByEdges, PrintKind::kPart, PrintKind::kAsAWhole};

PrintDoubt DoubtAt(std::size_t index) { return static_cast<PrintDoubt>(index); }

PrintDoubts AnyDoubts(Random* random) {
  PrintDoubts doubts;
  for (std::size_t i = 0; i < kPrintDoubts; ++i) doubts[DoubtAt(i)] = random->Uniform(-8, 2);
  return doubts;
}

TEST(PrintDoubts, UnknownDoubtsCostNothing) {
  for (const PrintKind kind : kKinds) {
    const PrintDoubts none;
    for (std::size_t i = 0; i < kPrintDoubts; ++i) {
      EXPECT_EQ(LogOddsTakenBy(kind, none, DoubtAt(i)), 0);
    }
    EXPECT_GT(ProbabilityOf(PrintLogOdds(kind, none)), 0.95);
  }
}

TEST(PrintDoubts, MoreDoubtNeverRaisesProbability) {
  Random random(1);
  for (const PrintKind kind : kKinds) {
    for (int trial = 0; trial < 200; ++trial) {
      PrintDoubts doubts = AnyDoubts(&random);
      for (std::size_t i = 0; i < kPrintDoubts; ++i) {
        const double before = PrintLogOdds(kind, doubts);
        doubts[DoubtAt(i)] += random.Uniform(0, 3);
        EXPECT_LE(PrintLogOdds(kind, doubts), before + 1e-9) << "doubt " << i;
      }
    }
  }
}

TEST(PrintDoubts, OddsAreReducedByEachDoubt) {
  Random random(2);
  for (const PrintKind kind : kKinds) {
    const PrintDoubts doubts = AnyDoubts(&random);
    double taken = 0;
    for (std::size_t i = 0; i < kPrintDoubts; ++i) {
      taken += LogOddsTakenBy(kind, doubts, DoubtAt(i));
    }
    EXPECT_NEAR(PrintLogOdds(kind, doubts), PrintLogOdds(kind, {}) - taken, 1e-9);
  }
}

// For every kind of print, every doubt that can be measured has weight somewhere.
TEST(PrintDoubts, AllDoubtsTogetherRejectPrint) {
  for (const PrintKind kind : kKinds) {
    PrintDoubts all;
    for (std::size_t i = 0; i < kPrintDoubts; ++i) all[DoubtAt(i)] = 2;
    EXPECT_LT(ProbabilityOf(PrintLogOdds(kind, all)), 1e-6);
  }
}

TEST(PrintDoubts, MainDoubtTakesMostOdds) {
  for (const PrintKind kind : kKinds) {
    for (std::size_t i = 0; i < kPrintDoubts; ++i) {
      PrintDoubts doubts;
      doubts[DoubtAt(i)] = 5;
      if (LogOddsTakenBy(kind, doubts, DoubtAt(i)) == 0) continue;  // without weight for this kind
      const std::string reason(MainDoubt(kind, doubts));
      // Smaller doubts do not change the reason.
      for (std::size_t other = 0; other < kPrintDoubts; ++other) {
        if (other == i) continue;
        PrintDoubts more = doubts;
        more[DoubtAt(other)] = 0.05;
        if (LogOddsTakenBy(kind, more, DoubtAt(other)) >= LogOddsTakenBy(kind, more, DoubtAt(i))) {
          continue;
        }
        EXPECT_EQ(MainDoubt(kind, more), reason);
      }
    }
  }
  PrintDoubts no_arm;
  no_arm[PrintDoubt::kInklessArm] = 1;
  EXPECT_EQ(MainDoubt(PrintKind::kByEdges, no_arm), "an arm of the cross is missing");
  PrintDoubts broken;
  broken[PrintDoubt::kBrokenRing] = 1;
  EXPECT_EQ(MainDoubt(PrintKind::kAsAWhole, broken), "the ring is broken");
}

TEST(PrintDoubts, EveryDoubtHasItsOwnReason) {
  std::set<std::string> reasons;
  std::size_t weighed = 0;
  for (std::size_t i = 0; i < kPrintDoubts; ++i) {
    PrintDoubts doubts;
    doubts[DoubtAt(i)] = 5;
    const bool by_edges = LogOddsTakenBy(PrintKind::kByEdges, doubts, DoubtAt(i)) > 0;
    const bool as_a_whole = LogOddsTakenBy(PrintKind::kAsAWhole, doubts, DoubtAt(i)) > 0;
    if (!by_edges && !as_a_whole) continue;
    ++weighed;
    reasons.emplace(MainDoubt(by_edges ? PrintKind::kByEdges : PrintKind::kAsAWhole, doubts));
  }
  EXPECT_EQ(reasons.size(), weighed);
  EXPECT_GT(weighed, 5u);
}

TEST(ProbabilityOf, ConvertsLogOdds) {
  EXPECT_EQ(ProbabilityOf(0), 0.5);
  EXPECT_NEAR(ProbabilityOf(std::log(9)), 0.9, 1e-12);
  EXPECT_NEAR(ProbabilityOf(-std::log(9)), 0.1, 1e-12);
  EXPECT_EQ(ProbabilityOf(-1e9), 0);
  EXPECT_EQ(ProbabilityOf(1e9), 1);
}

}  // namespace
}  // namespace kestrel
