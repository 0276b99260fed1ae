// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>

namespace kestrel {

// Kind of examination of a print: by its edges, whole (kByEdges) or cut off (kPart); or fitted as a
// whole (kAsAWhole) because its strokes are no wider than the blur.
enum class PrintKind { kByEdges, kPart, kAsAWhole };
inline constexpr std::size_t kPrintKinds = static_cast<std::size_t>(PrintKind::kAsAWhole) + 1;

// Doubts: numbers that speak against a located print. The larger a number, the less the print looks
// like the pattern. A doubt that was not measured does not count.
enum class PrintDoubt {
  // Ink and white (InkComparison). Shares of places, 0 to 1.
  kInklessArm,     // places of the worst arm that are not as dark as ink
  kDarkQuadrants,  // places between the arms too dark for white, in the best quadrant
  kInkOnWhite,     // places between the arms as dark as ink, in the best quadrant
  kDarkHub,        // places near the middle too dark for white, second worst of four quadrants
  kOtherSpoke,     // places as dark as ink on a line between the arms, the worst quadrant
  kOtherSpokes,    // the same, the second worst quadrant
  // Places around the ring too dark for white, median of the directions; or a stroke of another
  // ring, around or inside.
  kDarkBoard,
  kDarkCorners,  // the same: mean beyond the ends of the arms minus mean between them
  kUnlike,       // logarithm of (1 - correlation with the print)
  // Edges.
  kArmEdges,       // share of the arms' edges that are not in their place
  kWorstArmEdges,  // the same, of the worst arm
  kScatter,        // logarithm of the scatter of the edges, as a share of the ring's mean diameter
  kMisfit,         // the same of their distance from a flat print seen through the lens
  // Fit of the print as a whole.
  kFaintArm,  // share of the contrast that the worst arm lacks
  // Share of the contrast that the ring lacks, mean without the worst quarter. Of a print that is
  // examined by its edges: share of places that are not as dark as ink, without the worst eighth.
  kBrokenRing,
  kFrameCorners,  // darkness beyond the arms' ends minus that between them, in contrasts
  kOtherFigure,   // logarithm of (1 - correlation inside of the ring)
  kInside,        // residuals inside of the ring minus those on it, shares of the contrast
  kShadows,       // 1 where shadows were removed first, else 0
  // View of the print.
  kUncertain,  // logarithm of the position's standard deviation as a share of the distance
  kSmall,      // minus the logarithm of the ring's shorter diameter in pixels
  kFlat,       // minus the logarithm of the ring's axis ratio
  kHidden,     // share of ring and arms that is not in view
};
inline constexpr std::size_t kPrintDoubts = static_cast<std::size_t>(PrintDoubt::kHidden) + 1;

class PrintDoubts {
 public:
  // Initially none is measured.
  PrintDoubts() { values_.fill(-std::numeric_limits<double>::infinity()); }
  double& operator[](PrintDoubt doubt) { return values_[static_cast<std::size_t>(doubt)]; }
  double operator[](PrintDoubt doubt) const { return values_[static_cast<std::size_t>(doubt)]; }

 private:
  std::array<double, kPrintDoubts> values_;
};

// Weight of a doubt: a piecewise linear function. Each knot adds its slope beyond it.
struct DoubtWeight {
  std::array<double, 3> knots;
  std::array<double, 3> slopes;
};

// The weights of all doubts.
struct PrintWeights {
  double certain;  // log odds of a print without any doubt
  std::array<DoubtWeight, kPrintDoubts> doubts;
};

// Natural logarithm of the odds that a print is the landing pattern, and the part of it that one
// doubt takes away. The model is additive and falls with every doubt (logistic regression with
// weights that are not negative, trained by bench/train_print_score; the table is in
// print_score_weights.h).
double PrintLogOdds(const PrintWeights& weights, const PrintDoubts& doubts);
double PrintLogOdds(PrintKind kind, const PrintDoubts& doubts);
double LogOddsTakenBy(PrintKind kind, const PrintDoubts& doubts, PrintDoubt doubt);

// Returns the probability, 0 to 1, of the given logarithm of the odds.
double ProbabilityOf(double log_odds);

// Returns the doubt that takes the most log odds, in words.
std::string_view MainDoubt(PrintKind kind, const PrintDoubts& doubts);

}  // namespace kestrel
