// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>

namespace kestrel {

// How a print was looked at: by its edges, all or a part of it; or as a whole where its strokes are
// no wider than the blur.
enum class PrintKind { kByEdges, kPart, kAsAWhole };
inline constexpr std::size_t kPrintKinds = 3;

// What may speak against a print that was located. The larger a number, the less it looks like the
// pattern. What was not measured counts nothing.
enum class PrintDoubt {
  // By ink and white, see InkComparison. Shares of places, 0 to 1.
  kInklessArm,     // not as dark as ink, of the worst arm
  kDarkQuadrants,  // too dark for white between the arms, where it is best
  kInkOnWhite,     // the same, as dark as ink
  kDarkHub,        // too dark for white near the middle of the print, second worst of four
  kOtherSpoke,     // as dark as ink on a line between the arms, the worst
  kOtherSpokes,    // the same, of the second worst
  kDarkBoard,      // too dark for white around the ring, median of the directions
  kDarkCorners,    // the same beyond the ends of the arms, more than between them
  kUnlike,         // logarithm of what the correlation with the print lacks of 1
  // By edges
  kArmEdges,       // share of the edges of the arms that are not in their place
  kWorstArmEdges,  // the same, of the worst arm alone
  kScatter,        // logarithm of the scatter of the edges, of the ring's mean diameter
  kMisfit,         // logarithm of the edges' distance from a flat print seen through the lens
  // By the fit of the print as a whole
  kFaintArm,      // share of the contrast that the worst arm lacks
  kBrokenRing,    // share of the contrast that the ring lacks, mean but for the worst quarter
  kFrameCorners,  // darkness beyond the ends of the arms, against between them
  kOtherFigure,   // logarithm of what the correlation inside of the ring lacks of 1
  kInside,        // residuals inside of the ring more than on it, shares of the contrast
  kShadows,       // 1 where shadows had to be taken out to see it
  // By how little is seen of it
  kUncertain,  // logarithm of the position's standard deviation, of the distance
  kSmall,      // logarithm of the ring's shorter diameter in pixels, negative
  kFlat,       // logarithm of its axis ratio, negative
  kHidden,     // share of the print that is not in view
};
inline constexpr std::size_t kPrintDoubts = 23;

class PrintDoubts {
 public:
  // None of them, as long as nothing is known.
  PrintDoubts() { values_.fill(-std::numeric_limits<double>::infinity()); }
  double& operator[](PrintDoubt doubt) { return values_[static_cast<std::size_t>(doubt)]; }
  double operator[](PrintDoubt doubt) const { return values_[static_cast<std::size_t>(doubt)]; }

 private:
  std::array<double, kPrintDoubts> values_;
};

// How much a doubt counts: nothing below a knot, so much per unit beyond it.
struct DoubtWeight {
  std::array<double, 3> knots;
  std::array<double, 3> slopes;
};

// The same of all doubts.
struct PrintWeights {
  double certain;  // log odds of a print without any doubt
  std::array<DoubtWeight, kPrintDoubts> doubts;
};

// Logarithm of the odds that a print is the landing pattern, and how much of it a doubt takes: an
// additive model that falls with every doubt (logistic regression with weights that are not
// negative, bench/train_print_score; the table is in print_score_weights.h).
double PrintLogOdds(const PrintWeights& weights, const PrintDoubts& doubts);
double PrintLogOdds(PrintKind kind, const PrintDoubts& doubts);
double LogOddsTakenBy(PrintKind kind, const PrintDoubts& doubts, PrintDoubt doubt);

// Probability of such odds, 0 to 1.
double ProbabilityOf(double log_odds);

// What speaks against the print most, in words.
std::string_view MainDoubt(PrintKind kind, const PrintDoubts& doubts);

}  // namespace kestrel
