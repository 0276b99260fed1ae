// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace kestrel {

// Returns the contrast of what a CV_8UC1 image shows, bright parts minus dark parts, and the
// standard deviation of its noise per pixel, gray values, by a sample of its rows. Means of two by
// two pixels have half of the noise, but the same texture.
double MeasureContrast(const cv::Mat& image);
double MeasureNoise(const cv::Mat& image);

// Reduces the noise of dark frames before they are searched. There the steps from pixel to pixel
// are those of the noise, however wide the strokes of a print are.
class NoiseFilter {
 public:
  // Returns 'image', or, where it is dark and its noise hides a print, a copy with a fifth of the
  // noise and more contrast. The copy is valid until the next call. Does not allocate after
  // Reserve.
  const cv::Mat& Filter(const cv::Mat& image);

  // Reserves memory for images of this size.
  void Reserve(cv::Size size);

 private:
  void Smooth(const cv::Mat& image, double gain);

  std::vector<std::uint8_t> padded_;  // a row
  std::vector<std::uint16_t> rows_;   // smoothed along the rows
  cv::Mat filtered_;
};

}  // namespace kestrel
