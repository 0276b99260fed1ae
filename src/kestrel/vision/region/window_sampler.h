// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace kestrel {

// A part of an image at another scale, in planes of floats: one of gray values, or three.
struct SampledWindow {
  SampledWindow(int side_, int planes_) : side(side_), planes(planes_) {
    for (std::vector<float>& plane : values) plane.resize(std::size_t(side_) * side_);
  }

  int side, planes;
  std::array<std::vector<float>, 3> values;
};

// Resamples a part of an image by the mean over a triangle as wide as two pixels of the result,
// which is bilinear interpolation where the part is enlarged.
class WindowSampler {
 public:
  // Makes memory for images of a size, all parts of which can then be sampled without allocating.
  void Reserve(const cv::Size& image_size, int channels);

  // Reads the rectangle of 'size_px' around 'center_px' (integer coordinates are the centres of
  // pixels) to all of 'window'. 'image': CV_8UC1 or CV_8UC3; one of a single channel fills only the
  // first plane. Beyond its border the image goes on with its outermost pixels. Allocates only
  // where Reserve did not.
  void Sample(const cv::Mat& image, const Eigen::Vector2d& center_px,
              const Eigen::Vector2d& size_px, SampledWindow* window);

 private:
  // What a pixel of the result takes of the source.
  struct Taps {
    int first = 0, count = 0;      // pixels of the source, within the image
    std::size_t first_weight = 0;  // in the weights
  };
  struct Axis {
    std::vector<Taps> taps;
    std::vector<float> weights;

    void Fill(int side, double center_px, double size_px, int limit);
  };

  // Makes row 'y' of the result from the weighted sum of the source's rows, whose first column is
  // 'first'.
  template <int channels>
  void SampleRow(int first, int y, SampledWindow* window) const;

  Axis columns_, rows_;
  std::vector<float> row_;  // and one value that is read and not used
};

}  // namespace kestrel
