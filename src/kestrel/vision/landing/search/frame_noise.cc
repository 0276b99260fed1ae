// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/search/frame_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <span>

#include "kestrel/core/base/robust_statistics.h"

namespace kestrel {
namespace {

// The sample: pairs of rows at even distances, and every kSampleStep-th place on them.
constexpr int kRowPairs = 12;
constexpr int kSampleStep = 4;
constexpr int kRunPx = 16;      // pixels of a row, over which the contrast is free of noise
constexpr double kTail = 0.02;  // share of the darkest and of the brightest runs, left out

// Least noise, as a share of the contrast, that hides a print: two neighbouring pixels then differ
// as much as the least step of an edge.
constexpr double kHidingNoise = 0.08;
constexpr double kWantedContrast = 100;  // gray values, as in frames with light
constexpr double kMostGain = 8;

// Binomial: a Gaussian with a standard deviation of 1.4 px.
constexpr std::array<std::uint16_t, 5> kBinomial{70, 56, 28, 8, 1};  // from its middle
constexpr int kBinomialReach = kBinomial.size() - 1;
constexpr int kBinomialSum = 256;

// Absolute second differences of gray values.
class Roughness {
 public:
  void Add(int before, int here, int after) {
    ++histogram_[std::abs(before - 2 * here + after)];
    ++count_;
  }

  // Standard deviation of independent normal gray values with this median.
  double Sigma() const {
    const double half = 0.5 * count_;
    double below = 0;
    for (std::size_t i = 0; i < histogram_.size(); ++i) {
      if (below + histogram_[i] < half) {
        below += histogram_[i];
        continue;
      }
      constexpr double kMedianToSigma = 1.4826 / 2.449;  // by the root of 1 + 4 + 1
      const double within = (half - below) / std::max(1, histogram_[i]);
      return kMedianToSigma * std::max(0.0, static_cast<double>(i) + within - 0.5);
    }
    return 0;
  }

 private:
  static constexpr std::size_t kMost = 4 * 2 * 255 + 1;  // values for sums of four pixels
  std::array<int, kMost> histogram_{};
  int count_ = 0;
};

// Calls 'add' with each pair of rows of the sample.
template <class Add>
void ForRowPairs(const cv::Mat& image, const Add& add) {
  const int step = std::max(2, image.rows / kRowPairs);
  for (int y = step / 2; y + 1 < image.rows; y += step) add(image.ptr(y), image.ptr(y + 1));
}

// Means of runs of pixels.
class ContrastMeasurement {
 public:
  void Add(const std::uint8_t* upper, const std::uint8_t* lower, int width) {
    for (int x = 0; x + kRunPx <= width && runs_count_ < runs_.size(); x += kRunPx) {
      int total = 0;
      for (int i = x; i < x + kRunPx; ++i) total += upper[i] + lower[i];
      runs_[runs_count_++] = static_cast<float>(total) / (2 * kRunPx);
    }
  }

  double Result() {
    if (runs_count_ == 0) return 0;
    const std::span<float> runs = std::span(runs_).first(runs_count_);
    const auto rank = [&](double share) {
      return RankedInPlace(runs, static_cast<std::size_t>(share * (runs_count_ - 1)));
    };
    const double dark = rank(kTail);
    return rank(1 - kTail) - dark;
  }

 private:
  std::array<float, 4096> runs_;
  std::size_t runs_count_ = 0;
};

}  // namespace

double MeasureContrast(const cv::Mat& image) {
  ContrastMeasurement measurement;
  ForRowPairs(image, [&](const std::uint8_t* upper, const std::uint8_t* lower) {
    measurement.Add(upper, lower, image.cols);
  });
  return measurement.Result();
}

double MeasureNoise(const cv::Mat& image) {
  Roughness fine, coarse;
  ForRowPairs(image, [&](const std::uint8_t* upper, const std::uint8_t* lower) {
    const auto sum = [&](int x) { return upper[x] + upper[x + 1] + lower[x] + lower[x + 1]; };
    for (int x = 2; x + 3 < image.cols; x += kSampleStep) {
      // Clipped noise is no measure.
      if (upper[x] == 0 || upper[x] == 255) continue;
      fine.Add(upper[x - 1], upper[x], upper[x + 1]);
      coarse.Add(sum(x - 2), sum(x), sum(x + 2));
    }
  });
  // With the variances of noise and texture: fine^2 = n + t, coarse^2 = n / 4 + t.
  const double of_one = fine.Sigma(), of_four = coarse.Sigma() / 4;
  return std::sqrt(std::max(0.0, 4.0 / 3 * (of_one * of_one - of_four * of_four)));
}

void NoiseFilter::Reserve(cv::Size size) {
  padded_.resize(static_cast<std::size_t>(size.width) + 2 * kBinomialReach);
  rows_.resize(static_cast<std::size_t>(size.area()));
  filtered_.create(size, CV_8UC1);
}

const cv::Mat& NoiseFilter::Filter(const cv::Mat& image) {
  const double contrast = MeasureContrast(image);
  const bool is_dark = contrast <= kWantedContrast;
  if (!is_dark || MeasureNoise(image) <= kHidingNoise * contrast) return image;
  Smooth(image, std::min(kWantedContrast / std::max(1.0, contrast), kMostGain));
  return filtered_;
}

// The border pixels are repeated beyond the border.
void NoiseFilter::Smooth(const cv::Mat& image, double gain) {
  Reserve(image.size());
  const int width = image.cols, height = image.rows;
  const auto row = [&](int y) {
    return &rows_[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * width];
  };
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* const in = image.ptr(y);
    std::fill_n(padded_.begin(), kBinomialReach, in[0]);
    std::copy_n(in, width, padded_.begin() + kBinomialReach);
    std::fill_n(padded_.begin() + kBinomialReach + width, kBinomialReach, in[width - 1]);
    const std::uint8_t* const middle = padded_.data() + kBinomialReach;
    std::uint16_t* const out = row(y);
    for (int x = 0; x < width; ++x) {
      int sum = kBinomial[0] * middle[x];
      for (int i = 1; i <= kBinomialReach; ++i)
        sum += kBinomial[i] * (middle[x - i] + middle[x + i]);
      out[x] = static_cast<std::uint16_t>(sum);
    }
  }
  const auto scale = static_cast<float>(gain / (kBinomialSum * kBinomialSum));
  for (int y = 0; y < height; ++y) {
    std::array<const std::uint16_t*, 2 * kBinomialReach + 1> rows;
    for (int i = -kBinomialReach; i <= kBinomialReach; ++i) rows[i + kBinomialReach] = row(y + i);
    std::uint8_t* const out = filtered_.ptr(y);
    for (int x = 0; x < width; ++x) {
      int sum = kBinomial[0] * rows[kBinomialReach][x];
      for (int i = 1; i <= kBinomialReach; ++i) {
        sum += kBinomial[i] * (rows[kBinomialReach - i][x] + rows[kBinomialReach + i][x]);
      }
      out[x] = static_cast<std::uint8_t>(std::min(255.0f, scale * static_cast<float>(sum) + 0.5f));
    }
  }
}

}  // namespace kestrel
