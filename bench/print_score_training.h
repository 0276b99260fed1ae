// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/vision/landing/score/print_doubts.h"
#include "kestrel/vision/landing/score/print_score_weights.h"

namespace kestrel {

// A print that a search located in a frame.
struct ScoredPrint {
  PrintKind kind;
  PrintDoubts doubts;
  bool is_pattern;  // it lies where the frame has the pattern
};

// Hardships of a frame, one bit each: the conditions of stills, then these.
inline constexpr std::array<std::string_view, 4> kFrameHardships{"small", "near", "cut off",
                                                                 "worn"};

// All prints that a search located in a frame, without near misses of the pattern.
struct ScoredFrame {
  std::string name;
  unsigned hardships;  // one bit each
  bool is_held_out;    // it is not used for training
  bool has_pattern;
  std::vector<ScoredPrint> prints;
};

using PrintScore = std::array<PrintWeights, kPrintKinds>;

// Logistic regression with non-negative weights on hinges of the doubts. Each frame counts once,
// with the print that the score itself would choose (multiple-instance learning), as that print
// becomes the detection. The odds are those of such detections.
PrintScore TrainPrintScore(std::span<const ScoredFrame> frames);

// Detections with about the same reported probability.
struct ReliabilityBin {
  int count = 0;
  double mean_quality = 0;
  double right = 0;  // share of right ones
};

struct Reliability {
  std::vector<ReliabilityBin> bins;  // of equal width
  // Mean over all detections of the difference between quality and share of their bin (Naeini et
  // al. 2015).
  double expected_calibration_error = 0;
};

// Uses one detection of each frame that has any: its most probable print.
Reliability MeasureReliability(const PrintScore& score, std::span<const ScoredFrame> frames);

// Shares of frames with a detection of at least a given quality.
struct DetectionRates {
  double found = 0;         // of frames with the pattern
  double false_of_all = 0;  // of frames without it
};
DetectionRates MeasureRates(const PrintScore& score, std::span<const ScoredFrame> frames,
                            double min_quality);

// Returns the table of weights as a source file.
std::string ToSource(const PrintScore& score);

}  // namespace kestrel
