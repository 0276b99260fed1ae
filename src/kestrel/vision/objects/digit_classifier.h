// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "kestrel/vision/objects/digit_image.h"

namespace kestrel {

inline constexpr int kDigitCount = 10;

// How likely each digit is; they add up to 1. A 6 and a 9 are the same figure turned by a half, and
// nothing tells which way is up: both are equally likely.
using DigitLikelihoods = std::array<double, kDigitCount>;

// The likeliest digit and its probability; of a 6 and a 9 that are equally likely the 6.
struct LikelyDigit {
  int digit = 0;
  double probability = 0;
};
LikelyDigit LikeliestDigit(const DigitLikelihoods& likelihoods);

// A digit looks different in upright, slanted, thin and bold fonts: it has several figures, those
// of digit d are d * kStyleCount and the next ones.
inline constexpr int kStyleCount = 8;
inline constexpr int kFigureCount = kDigitCount * kStyleCount;

// Share of the training images of a figure in which each of its pixels was set, 0 < share < 1.
using DigitFigure = std::array<float, kDigitSide * kDigitSide>;
using DigitModel = std::array<DigitFigure, kFigureCount>;

// From the text that PrintDigitModel makes; 'file' is for messages. Throws InputError.
DigitModel ParseDigitModel(const std::string& text, const std::string& file);
std::string PrintDigitModel(const DigitModel& model);

// Trained by tools/train_digits on fonts, blur, light and oblique views.
const DigitModel& DefaultDigitModel();

// Pixel-wise naive Bayes over the four orientations (paper, section 3.6); a digit is as likely as
// the likeliest of its figures. Immutable, thread-safe.
class DigitClassifier {
 public:
  explicit DigitClassifier(const DigitModel& model);

  DigitLikelihoods Classify(const DigitViews& views) const;

  // Of the digit's figures, as the image stands.
  int LikeliestFigure(const DigitImage& image, int digit) const;

 private:
  double LogLikelihood(const DigitImage& image, int figure) const;

  // Logarithm of the probability of a pixel that is set, minus that of one that is not; and the
  // logarithm of an image without any set pixel.
  DigitModel set_gain_;
  std::array<double, kFigureCount> empty_;
};

// Learns the figures from labelled images: those of a digit are divided among its figures such that
// each is with the figure that makes it likeliest (expectation maximisation with hard choices).
class DigitTrainer {
 public:
  void Add(int digit, const DigitImage& image) { images_[digit].push_back(image); }
  // Starts with equal parts of the images in the order in which they came: fonts one after the
  // other. Laplace's rule: no pixel is certain. Figures without an image are even noise.
  DigitModel Model() const;

 private:
  std::array<std::vector<DigitImage>, kDigitCount> images_;
};

}  // namespace kestrel
