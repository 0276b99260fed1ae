// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace kestrel {

// Noise of an image and the contrast of what it shows, gray values.
struct FrameNoise {
  double sigma = 0;     // standard deviation per pixel
  double contrast = 0;  // bright parts minus dark parts
};

// Measures a sample of a CV_8UC1 image. Averages of two by two pixels have half of the noise, but
// the same texture.
FrameNoise MeasureNoise(const cv::Mat& image);

// Reduces the noise of dark frames before they are searched. There the steps from pixel to pixel
// are those of the noise, however wide the strokes of a print are.
class NoiseFilter {
 public:
  // Returns 'image', or, where its noise hides a print, a copy with a fifth of the noise and more
  // contrast. The copy is valid until the next call. Does not allocate after Reserve.
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
