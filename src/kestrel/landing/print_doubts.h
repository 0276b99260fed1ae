// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>

namespace kestrel {

// How a print was looked at: by its edges, or as a whole where its strokes are no wider than the
// blur.
enum class PrintKind { kByEdges, kAsAWhole };
inline constexpr std::size_t kPrintKinds = 2;

// What may speak against a print that was located. The larger a number, the less it looks like the
// pattern.
enum class PrintDoubt {
  kArmMissing,    // share of the contrast that the worst arm lacks
  kArmsWeak,      // the same, mean of the arms
  kDarkQuadrant,  // share of the contrast that the white between the arms lacks, mean
  kBrokenRing,    // share of the contrast that the ring lacks, mean but for the worst quarter
  kArmEdges,      // share of the edges of the arms that are not in their place
  kRingEdges,     // share of the edges of the ring that are not, but for the worst quarter
  kOtherSpokes,   // darkness of lines between the arms
  kFrameCorners,  // darkness beyond the ends of the arms, against between them
  kDarkBoard,     // darkness of the board around the ring
  kOtherFigure,   // logarithm of what the correlation inside of the ring lacks of 1
  kUnlike,        // the same of the whole print
  kUnexplained,   // share of the variance of the gray values that the print leaves
  kInside,        // residuals inside of the ring more than on it, shares of the contrast
  kOnRing,        // residuals on the ring more than inside
  kAround,        // residuals around it more than on it and inside
  kScatter,       // logarithm of the scatter of the edges, of the ring's mean diameter
  kMisfit,        // logarithm of the edges' distance from a flat print seen through the lens
  kUncertain,     // logarithm of the position's standard deviation, of the distance
  kSmall,         // logarithm of the ring's mean diameter in pixels, negative
  kFlat,          // logarithm of its axis ratio, negative
  kHidden,        // share of the print that is not in view
  kShadows,       // 1 where shadows had to be taken out to see it
};
inline constexpr std::size_t kPrintDoubts = 22;

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

// Logarithm of the odds that a print is the landing pattern, and how much of it a doubt takes: an
// additive model that falls with every doubt (logistic regression with weights that are not
// negative, tools/train_print_score; the table is in print_score_weights.h).
double PrintLogOdds(PrintKind kind, const PrintDoubts& doubts);
double LogOddsTakenBy(PrintKind kind, const PrintDoubts& doubts, PrintDoubt doubt);

// Probability of such odds, 0 to 1.
double ProbabilityOf(double log_odds);

// What speaks against the print most, in words.
std::string_view MainDoubt(PrintKind kind, const PrintDoubts& doubts);

}  // namespace kestrel
