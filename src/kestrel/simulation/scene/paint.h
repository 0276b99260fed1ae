// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/drawing.h"
#include "kestrel/simulation/scene/texture.h"

namespace kestrel {

// Reflectance of paint: blue, green, red, each 0 to 1.
using Color = Eigen::Vector3d;

Color Gray(double reflectance);

// The same as codes, for OpenCV's drawing functions.
cv::Scalar CodesOf(const Color& color);

// Noise at all scales from 'largest_px' down, in 'octaves' steps of 'ratio': CV_32F, about -1 to 1,
// mean 0; opposite sides fit each other. 'size' is a power of two.
cv::Mat FractalNoise(cv::Size size, double largest_px, int octaves, double ratio,
                     std::uint64_t seed);

// CV_8UC3 codes of a colour that varies with 'noise' (CV_32F) by the part 'variation'.
cv::Mat Painted(const Color& color, double variation, const cv::Mat& noise);

// Paint of one even colour.
std::shared_ptr<const Texture> PlainPaint(const Color& color, int channels);

// Paint of a square of 'size_m' around the origin, 'size_px' wide, with its drawings in order and
// exact edges.
class SquarePaint {
 public:
  SquarePaint(int size_px, double size_m, const Color& color);

  void Draw(const Drawing& drawing, const Color& color);
  // Dirt and wear: the reflectance varies by the part 'variation'.
  void Soil(double variation, std::uint64_t seed);

  const cv::Mat& codes() const { return codes_; }
  std::shared_ptr<const Texture> ToTexture(int channels) const;

 private:
  void DrawPixels(const cv::Rect& block, const Drawing& drawing, const Color& color);
  // 'pixel' is counted from the upper left corner.
  Eigen::Vector2d PointAt(const Eigen::Vector2d& pixel) const;

  double size_m_;
  cv::Mat codes_;
};

}  // namespace kestrel
