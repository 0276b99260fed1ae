// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "kestrel/vision/objects/digit_likelihoods.h"
#include "kestrel/vision/objects/digits/digit_image.h"

namespace kestrel {

// A digit looks different in upright, slanted, thin and bold fonts. It therefore has several
// figures: digit d has the figures from d * kStyleCount on.
inline constexpr int kStyleCount = 8;
inline constexpr int kFigureCount = kDigitCount * kStyleCount;

// For each pixel, the share of a figure's training images in which it was set, 0 < share < 1.
using DigitFigure = std::array<float, kDigitSide * kDigitSide>;
using DigitModel = std::array<DigitFigure, kFigureCount>;

// Reads the text that PrintDigitModel writes. 'file' is for messages. Throws InputError.
DigitModel ParseDigitModel(const std::string& text, const std::string& file);
std::string PrintDigitModel(const DigitModel& model);

// Trained by tools/train_digits on fonts, blur, light and oblique views.
const DigitModel& DefaultDigitModel();

// Pixel-wise naive Bayes over the four orientations (paper, section 3.6). A digit is as likely as
// the likeliest of its figures. What is no digit is as likely as the mean of all figures makes it;
// by its probability the result is uniform, as after no digit at all. Immutable and thread-safe.
class DigitClassifier {
 public:
  explicit DigitClassifier(const DigitModel& model);

  DigitLikelihoods Classify(const DigitViews& views) const;

  // Returns the likeliest of the digit's figures, without turning the image.
  int LikeliestFigure(const DigitImage& image, int digit) const;

 private:
  // Logarithms of a figure's shares.
  struct LogFigure {
    DigitFigure set_gain;  // log-probability that a pixel is set, minus that it is not
    double empty = 0;      // log-probability of an image without set pixels
  };
  static LogFigure LogOf(const DigitFigure& figure);
  static double LogLikelihood(const DigitImage& image, const LogFigure& figure);

  std::array<LogFigure, kFigureCount> figures_;
  LogFigure mean_;
};

// Learns the figures from labelled images. The images of a digit are divided among its figures such
// that each image belongs to the figure that makes it likeliest (expectation maximisation with hard
// choices).
class DigitTrainer {
 public:
  void Add(int digit, const DigitImage& image) { images_[digit].push_back(image); }
  // Starts with equal parts of the images in the order of Add: one font after the other. Laplace's
  // rule: no pixel is certain. A figure without images is uniform noise.
  DigitModel Model() const;

 private:
  std::array<std::vector<DigitImage>, kDigitCount> images_;
};

}  // namespace kestrel
