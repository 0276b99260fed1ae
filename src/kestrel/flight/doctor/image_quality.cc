// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/image_quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/vision/pipeline/repeated_image.h"

namespace kestrel {
namespace {

constexpr int kGrays = 256;

using Histogram = std::array<int, kGrays>;

Histogram HistogramOf(const cv::Mat& gray) {
  Histogram histogram{};
  for (int y = 0; y < gray.rows; ++y) {
    const auto* row = gray.ptr<std::uint8_t>(y);
    for (int x = 0; x < gray.cols; ++x) ++histogram[row[x]];
  }
  return histogram;
}

// Returns the gray value that 'share' of the pixels do not exceed.
double Quantile(const Histogram& histogram, double share, double pixels) {
  double below = 0;
  for (int gray = 0; gray < kGrays; ++gray) {
    below += histogram[gray];
    if (below >= share * pixels) return gray;
  }
  return kGrays - 1;
}

// Appends the widths (pixels) of the edges along a line: rise over steepest slope. Small rises may
// be noise and are left out.
void MeasureEdges(const std::uint8_t* line, int size, std::vector<double>* widths) {
  constexpr int kLeastRise = 40;
  int start = 0;
  while (start + 1 < size) {
    const int direction = line[start + 1] > line[start] ? 1 : -1;
    int steepest = 0;
    int end = start;
    while (end + 1 < size && direction * (line[end + 1] - line[end]) > 0) {
      steepest = std::max(steepest, direction * (line[end + 1] - line[end]));
      ++end;
    }
    const int rise = std::abs(line[end] - line[start]);
    if (rise >= kLeastRise) widths->push_back(static_cast<double>(rise) / steepest);
    start = std::max(end, start + 1);
  }
}

// Returns a width among the sharper edges: oblique or soft edges carry no information about the
// lens.
std::optional<double> SharpEdges(const cv::Mat& gray) {
  constexpr std::size_t kFewest = 30;
  constexpr double kSharper = 0.25;
  cv::Mat turned;
  cv::transpose(gray, turned);
  std::vector<double> widths;
  for (const cv::Mat& image : {gray, turned}) {
    for (int y = 0; y < image.rows; ++y) {
      MeasureEdges(image.ptr<std::uint8_t>(y), image.cols, &widths);
    }
  }
  if (widths.size() < kFewest) return std::nullopt;
  return QuantileInPlace(widths, kSharper, QuantileRank::kShareBelow);
}

}  // namespace

ImageQuality MeasureImageQuality(const cv::Mat& image) {
  constexpr double kShare = 0.01;
  constexpr int kSaturated = 250;
  cv::Mat gray = image;
  if (image.channels() > 1) cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  const Histogram histogram = HistogramOf(gray);
  const auto pixels = static_cast<double>(gray.total());
  ImageQuality quality;
  double sum = 0;
  double saturated = 0;
  for (int value = 0; value < kGrays; ++value) {
    sum += static_cast<double>(value) * histogram[value];
    if (value >= kSaturated) saturated += histogram[value];
  }
  quality.mean_gray = sum / pixels;
  quality.saturated_share = saturated / pixels;
  quality.dark_gray = Quantile(histogram, kShare, pixels);
  quality.bright_gray = Quantile(histogram, 1 - kShare, pixels);
  quality.edge_px = SharpEdges(gray);
  quality.hash = HashOf(image);
  return quality;
}

}  // namespace kestrel
