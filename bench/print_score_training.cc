// SPDX-License-Identifier: BSD-3-Clause
#include "print_score_training.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "kestrel/core/base/robust_statistics.h"

namespace kestrel {
namespace {

constexpr std::size_t kKnots = 3;
constexpr std::array<double, kKnots> kKnotQuantiles{0.2, 0.8, 0.98};  // of the patterns' doubts
constexpr std::size_t kHinges = kKnots * kPrintDoubts;
constexpr double kRidge = 1e-4;
constexpr int kRounds = 3;
constexpr int kSweeps = 150;
constexpr double kLeastKnot = -99;  // for unknown doubts

double Sigmoid(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

double LogOdds(const PrintScore& score, const ScoredPrint& print) {
  return PrintLogOdds(score[static_cast<std::size_t>(print.kind)], print.doubts);
}

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  return QuantileInPlace(values, share, QuantileRank::kShareBelow);
}

const ScoredPrint* MostProbable(const PrintScore& score, const ScoredFrame& frame,
                                const std::function<bool(const ScoredPrint&)>& counts) {
  const ScoredPrint* best = nullptr;
  for (const ScoredPrint& print : frame.prints) {
    if (!counts(print)) continue;
    if (best == nullptr || LogOdds(score, print) > LogOdds(score, *best)) best = &print;
  }
  return best;
}

// The kinds of prints that one kind is trained with. The doubts of whole prints apply to parts of
// prints too, of which there are fewer.
std::vector<PrintKind> LearnedFrom(PrintKind kind) {
  if (kind == PrintKind::kPart) return {PrintKind::kPart, PrintKind::kByEdges};
  return {kind};
}

// The prints that a kind is trained with: all, or for each frame the most probable pattern and the
// most probable other print.
std::vector<const ScoredPrint*> Select(std::span<const ScoredFrame> frames, PrintKind kind,
                                       const PrintScore* score) {
  std::vector<const ScoredPrint*> selected;
  for (const ScoredFrame& frame : frames) {
    for (const PrintKind of : LearnedFrom(kind)) {
      for (const bool is_pattern : {true, false}) {
        const auto counts = [&](const ScoredPrint& print) {
          return print.kind == of && print.is_pattern == is_pattern;
        };
        if (score != nullptr) {
          const ScoredPrint* best = MostProbable(*score, frame, counts);
          if (best != nullptr) selected.push_back(best);
          continue;
        }
        for (const ScoredPrint& print : frame.prints) {
          if (counts(print)) selected.push_back(&print);
        }
      }
    }
  }
  return selected;
}

// Logistic regression by coordinate descent.
class Regression {
 public:
  explicit Regression(std::span<const ScoredPrint* const> prints) : prints_(prints) {
    SetKnots();
    for (std::size_t hinge = 0; hinge < kHinges; ++hinge) SetColumn(hinge);
    log_odds_.assign(prints.size(), 0);
  }

  PrintWeights Solve() {
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      StepIntercept();
      for (std::size_t hinge = 0; hinge < kHinges; ++hinge) StepSlope(hinge);
    }
    for (std::size_t hinge = 0; hinge < kHinges; ++hinge) {
      weights_.doubts[hinge / kKnots].slopes[hinge % kKnots] = slopes_[hinge];
    }
    return weights_;
  }

 private:
  void SetKnots() {
    for (std::size_t i = 0; i < kPrintDoubts; ++i) {
      std::vector<double> of_patterns;
      for (const ScoredPrint* print : prints_) {
        if (print->is_pattern) of_patterns.push_back(print->doubts[static_cast<PrintDoubt>(i)]);
      }
      for (std::size_t k = 0; k < kKnots; ++k) {
        weights_.doubts[i].knots[k] =
            std::max(kLeastKnot, Quantile(of_patterns, kKnotQuantiles[k]));
      }
    }
  }

  void SetColumn(std::size_t hinge) {
    const std::size_t doubt = hinge / kKnots;
    const double knot = weights_.doubts[doubt].knots[hinge % kKnots];
    double sum = 0, squares = 0;
    for (const ScoredPrint* print : prints_) {
      const double value = std::max(0.0, print->doubts[static_cast<PrintDoubt>(doubt)] - knot);
      columns_[hinge].push_back(static_cast<float>(value));
      sum += value;
      squares += value * value;
    }
    const auto count = static_cast<double>(prints_.size());
    variances_[hinge] = std::max(0.0, squares / count - sum * sum / (count * count));
  }

  void StepIntercept() {
    double gradient = 0, curvature = 1e-9;
    for (std::size_t i = 0; i < prints_.size(); ++i) {
      const double p = Sigmoid(log_odds_[i]);
      gradient += prints_[i]->is_pattern - p;
      curvature += p * (1 - p);
    }
    const double step = std::clamp(gradient / curvature, -1.0, 1.0);
    weights_.certain += step;
    for (double& log_odds : log_odds_) log_odds += step;
  }

  void StepSlope(std::size_t hinge) {
    constexpr double kLeastVariance = 1e-10;
    constexpr double kMaxStep = 2;  // log odds per standard deviation
    if (variances_[hinge] < kLeastVariance) return;
    const double ridge = kRidge * static_cast<double>(prints_.size()) * variances_[hinge];
    double gradient = -ridge * slopes_[hinge], curvature = ridge;
    for (std::size_t i = 0; i < prints_.size(); ++i) {
      const double value = columns_[hinge][i];
      if (value == 0) continue;
      const double p = Sigmoid(log_odds_[i]);
      gradient -= (prints_[i]->is_pattern - p) * value;
      curvature += p * (1 - p) * value * value;
    }
    const double max_step = kMaxStep / std::sqrt(variances_[hinge]);
    const double slope =
        std::max(0.0, slopes_[hinge] + std::clamp(gradient / curvature, -max_step, max_step));
    const double step = slope - slopes_[hinge];
    if (step == 0) return;
    slopes_[hinge] = slope;
    for (std::size_t i = 0; i < prints_.size(); ++i) log_odds_[i] -= step * columns_[hinge][i];
  }

  std::span<const ScoredPrint* const> prints_;
  PrintWeights weights_{};
  std::array<std::vector<float>, kHinges> columns_;
  std::array<double, kHinges> variances_{};
  std::array<double, kHinges> slopes_{};
  std::vector<double> log_odds_;
};

// The detection of a frame: its most probable print.
struct Detected {
  double log_odds;
  bool is_right;
};
std::vector<Detected> Detections(const PrintScore& score, std::span<const ScoredFrame> frames) {
  std::vector<Detected> detections;
  for (const ScoredFrame& frame : frames) {
    const ScoredPrint* best = MostProbable(score, frame, [](const auto&) { return true; });
    if (best != nullptr) detections.push_back({LogOdds(score, *best), best->is_pattern});
  }
  return detections;
}

// Makes the log odds those of detections (Platt 1999), by logistic regression on which are right.
void Calibrate(std::span<const ScoredFrame> frames, PrintScore* score) {
  const std::vector<Detected> detections = Detections(*score, frames);
  double slope = 1, offset = 0;
  constexpr int kSteps = 30;
  for (int step = 0; step < kSteps; ++step) {
    double gs = 0, go = 0, ss = 1e-9, so = 0, oo = 1e-9;
    for (const Detected& d : detections) {
      const double p = Sigmoid(slope * d.log_odds + offset);
      const double error = d.is_right - p, weight = p * (1 - p);
      gs += error * d.log_odds;
      go += error;
      ss += weight * d.log_odds * d.log_odds;
      so += weight * d.log_odds;
      oo += weight;
    }
    const double determinant = ss * oo - so * so;
    slope += (oo * gs - so * go) / determinant;
    offset += (ss * go - so * gs) / determinant;
  }
  for (PrintWeights& weights : *score) {
    weights.certain = slope * weights.certain + offset;
    for (DoubtWeight& weight : weights.doubts) {
      for (double& of_knot : weight.slopes) of_knot *= slope;
    }
  }
}

}  // namespace

PrintScore TrainPrintScore(std::span<const ScoredFrame> frames) {
  PrintScore score{};
  for (int round = 0; round < kRounds; ++round) {
    const PrintScore before = score;
    for (std::size_t kind = 0; kind < kPrintKinds; ++kind) {
      score[kind] =
          Regression(Select(frames, static_cast<PrintKind>(kind), round > 0 ? &before : nullptr))
              .Solve();
    }
  }
  Calibrate(frames, &score);
  return score;
}

Reliability MeasureReliability(const PrintScore& score, std::span<const ScoredFrame> frames) {
  constexpr std::size_t kBins = 10;
  Reliability reliability;
  reliability.bins.resize(kBins);
  const std::vector<Detected> detections = Detections(score, frames);
  for (const Detected& detection : detections) {
    const double quality = Sigmoid(detection.log_odds);
    ReliabilityBin& bin =
        reliability.bins[std::min(kBins - 1, static_cast<std::size_t>(kBins * quality))];
    ++bin.count;
    bin.mean_quality += quality;
    bin.right += detection.is_right;
  }
  for (ReliabilityBin& bin : reliability.bins) {
    if (bin.count == 0) continue;
    reliability.expected_calibration_error +=
        std::abs(bin.mean_quality - bin.right) / static_cast<double>(detections.size());
    bin.mean_quality /= bin.count;
    bin.right /= bin.count;
  }
  return reliability;
}

DetectionRates MeasureRates(const PrintScore& score, std::span<const ScoredFrame> frames,
                            double min_quality) {
  DetectionRates rates;
  double with = 0, without = 0;
  for (const ScoredFrame& frame : frames) {
    const ScoredPrint* best = MostProbable(score, frame, [](const auto&) { return true; });
    const bool detected = best != nullptr && Sigmoid(LogOdds(score, *best)) >= min_quality;
    (frame.has_pattern ? with : without) += 1;
    if (detected && frame.has_pattern) rates.found += best->is_pattern;
    if (detected && !frame.has_pattern) rates.false_of_all += 1;
  }
  rates.found /= std::max(1.0, with);
  rates.false_of_all /= std::max(1.0, without);
  return rates;
}

std::string ToSource(const PrintScore& score) {
  std::string source =
      "// SPDX-License-Identifier: BSD-3-Clause\n"
      "// Made by bench/train_print_score.\n"
      "#pragma once\n\n#include <array>\n\n#include "
      "\"kestrel/vision/landing/score/print_doubts.h\"\n\n"
      "namespace kestrel {\n\n"
      "// clang-format off\n"
      "inline constexpr std::array<PrintWeights, kPrintKinds> kPrintWeights = {{\n";
  for (const PrintWeights& weights : score) {
    source += fmt::format("    {{{:.3f},\n     {{{{\n", weights.certain);
    for (const DoubtWeight& weight : weights.doubts) {
      source += fmt::format("         {{{{{:.4g}}}, {{{:.4g}}}}},\n", fmt::join(weight.knots, ", "),
                            fmt::join(weight.slopes, ", "));
    }
    source += "     }}},\n";
  }
  return source + "}};\n// clang-format on\n\n}  // namespace kestrel\n";
}

}  // namespace kestrel
