// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/vision/landing/print_doubts.h"
#include "kestrel/vision/landing/print_score_weights.h"

namespace kestrel {

// A print that a search located in a frame.
struct ScoredPrint {
  PrintKind kind;
  PrintDoubts doubts;
  bool is_pattern;  // whether it lies where the frame has the pattern
};

// What a frame may be hard to see by, a bit each: the conditions of stills, then these.
inline constexpr std::array<std::string_view, 4> kFrameHardships{"small", "near", "cut off",
                                                                 "worn"};

// All that a search located in a frame, near misses of the pattern left out.
struct ScoredFrame {
  std::string name;
  unsigned hardships;  // bits
  bool is_held_out;    // nothing is trained on it
  bool has_pattern;
  std::vector<ScoredPrint> prints;
};

using PrintScore = std::array<PrintWeights, kPrintKinds>;

// Logistic regression with weights that are not negative, on hinges of the doubts. A frame counts
// once: with the print that the score itself would choose of it (multiple-instance learning), for
// that one decides what is detected. The odds are those of such detections.
PrintScore TrainPrintScore(std::span<const ScoredFrame> frames);

// Detections that were said to be about as probable.
struct ReliabilityBin {
  int count = 0;
  double mean_quality = 0;
  double right = 0;  // share of them
};

struct Reliability {
  std::vector<ReliabilityBin> bins;  // of equal width
  // Mean over all detections of how far the bin's quality is from its share (Naeini et al. 2015).
  double expected_calibration_error = 0;
};

// A detection of each frame that has any: its most probable print.
Reliability MeasureReliability(const PrintScore& score, std::span<const ScoredFrame> frames);

// Shares of frames at a least quality.
struct DetectionRates {
  double found = 0;         // of those with the pattern
  double false_of_all = 0;  // detections in those without
};
DetectionRates MeasureRates(const PrintScore& score, std::span<const ScoredFrame> frames,
                            double min_quality);

// The table of weights as a source file.
std::string ToSource(const PrintScore& score);

}  // namespace kestrel
