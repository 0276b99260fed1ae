// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "kestrel/objects/digit_image.h"

namespace kestrel {

inline constexpr int kDigitCount = 10;

// How likely each digit is; they add up to 1. A 6 and a 9 are the same figure turned by a half:
// where nothing tells which way is up, both are equally likely.
using DigitLikelihoods = std::array<double, kDigitCount>;

// Share of the training images of a digit in which each of its pixels was set, 0 < share < 1.
using DigitModel = std::array<std::array<float, kDigitSide * kDigitSide>, kDigitCount>;

// From the text that PrintDigitModel makes; 'file' is for messages. Throws InputError.
DigitModel ParseDigitModel(const std::string& text, const std::string& file);
std::string PrintDigitModel(const DigitModel& model);

// Trained by tools/train_digits on fonts, blur, light and oblique views.
const DigitModel& DefaultDigitModel();

// Pixel-wise naive Bayes over the four orientations (paper, section 3.6). Immutable, thread-safe.
class DigitClassifier {
 public:
  explicit DigitClassifier(const DigitModel& model);

  DigitLikelihoods Classify(const DigitImage& digit) const;

 private:
  // Logarithm of the probability of a pixel that is set, minus that of one that is not; and the
  // logarithm of an image without any set pixel.
  std::array<std::array<float, kDigitSide * kDigitSide>, kDigitCount> set_gain_;
  std::array<double, kDigitCount> empty_;
};

// Counts the set pixels of labelled images.
class DigitTrainer {
 public:
  void Add(int digit, const DigitImage& image);
  // Laplace's rule: no pixel is certain. Digits without an image are even noise.
  DigitModel Model() const;

 private:
  DigitModel set_{};
  std::array<int, kDigitCount> images_{};
};

}  // namespace kestrel
