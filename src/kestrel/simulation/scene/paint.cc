// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/paint.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace kestrel {
namespace {

// Random numbers on a lattice of at least 4 x 4, interpolated smoothly.
cv::Mat ValueNoise(cv::Size size, double cell_px, Random* random) {
  const int columns = std::clamp(static_cast<int>(size.width / cell_px), 4, size.width);
  const int rows = std::clamp(static_cast<int>(size.height / cell_px), 4, size.height);
  cv::Mat lattice(rows, columns, CV_32F);
  lattice.forEach<float>([](float& value, const int*) { value = 0; });
  for (int i = 0; i < rows * columns; ++i) {
    lattice.at<float>(i / columns, i % columns) = static_cast<float>(random->Uniform(-1, 1));
  }
  // The margin comes from the opposite side, so that the noise repeats.
  constexpr int kMargin = 2;
  cv::Mat wrapped;
  cv::copyMakeBorder(lattice, wrapped, kMargin, kMargin, kMargin, kMargin, cv::BORDER_WRAP);
  const double scale_x = static_cast<double>(size.width) / columns;
  const double scale_y = static_cast<double>(size.height) / rows;
  cv::Mat enlarged;
  cv::resize(wrapped, enlarged, {}, scale_x, scale_y, cv::INTER_CUBIC);
  const cv::Rect inside(static_cast<int>(kMargin * scale_x), static_cast<int>(kMargin * scale_y),
                        size.width, size.height);
  return enlarged(inside & cv::Rect({}, enlarged.size())).clone();
}

}  // namespace

Color Gray(double reflectance) { return Color::Constant(reflectance); }

cv::Scalar CodesOf(const Color& color) {
  return {static_cast<double>(CodeOfReflectance(color[0])),
          static_cast<double>(CodeOfReflectance(color[1])),
          static_cast<double>(CodeOfReflectance(color[2]))};
}

cv::Mat FractalNoise(cv::Size size, double largest_px, int octaves, double ratio,
                     std::uint64_t seed) {
  Random random(seed);
  cv::Mat sum = cv::Mat::zeros(size, CV_32F);
  double cell_px = largest_px;
  for (int i = 0; i < octaves && cell_px >= 1; ++i) {
    sum += ValueNoise(size, cell_px, &random);
    cell_px /= ratio;
  }
  return sum * 0.6;
}

cv::Mat Painted(const Color& color, double variation, const cv::Mat& noise) {
  cv::Mat steps;
  constexpr double kStepsPerUnit = 60;
  noise.convertTo(steps, CV_8U, kStepsPerUnit, 128);
  cv::Mat table(1, 256, CV_8UC3);
  for (int i = 0; i < 256; ++i) {
    const double factor = std::max(1 + variation * (i - 128) / kStepsPerUnit, 0.05);
    for (int c = 0; c < 3; ++c) {
      table.at<cv::Vec3b>(i)[c] = CodeOfReflectance(factor * color[c]);
    }
  }
  cv::Mat three;
  cv::cvtColor(steps, three, cv::COLOR_GRAY2BGR);
  cv::Mat codes;
  cv::LUT(three, table, codes);
  return codes;
}

std::shared_ptr<const Texture> PlainPaint(const Color& color, int channels) {
  return std::make_shared<Texture>(cv::Mat(1, 1, CV_8UC3, CodesOf(color)), channels);
}

SquarePaint::SquarePaint(int size_px, double size_m, const Color& color)
    : size_m_(size_m), codes_(size_px, size_px, CV_8UC3, CodesOf(color)) {}

void SquarePaint::Draw(const Drawing& drawing, const Color& color) {
  const double pixel_m = size_m_ / codes_.cols;
  constexpr int kBlock_px = 16;
  for (int top = 0; top < codes_.rows; top += kBlock_px) {
    for (int left = 0; left < codes_.cols; left += kBlock_px) {
      const cv::Rect block =
          cv::Rect(left, top, kBlock_px, kBlock_px) & cv::Rect({}, codes_.size());
      const Eigen::Vector2d middle(left + 0.5 * block.width, top + 0.5 * block.height);
      const double distance = drawing.NearestEdge(PointAt(middle)).distance;
      const double reach = (0.5 * std::hypot(block.width, block.height) + 1) * pixel_m;
      if (distance > reach) continue;
      if (distance < -reach) {
        codes_(block) = CodesOf(color);
      } else {
        DrawPixels(block, drawing, color);
      }
    }
  }
}

void SquarePaint::DrawPixels(const cv::Rect& block, const Drawing& drawing, const Color& color) {
  const double pixel_m = size_m_ / codes_.cols;
  for (int v = block.y; v < block.y + block.height; ++v) {
    for (int u = block.x; u < block.x + block.width; ++u) {
      const double distance = drawing.NearestEdge(PointAt({u + 0.5, v + 0.5})).distance;
      const double cover = Coverage(distance, pixel_m);
      cv::Vec3b& codes = codes_.at<cv::Vec3b>(v, u);
      for (int c = 0; c < 3; ++c) {
        const double below = kReflectanceOfCode[codes[c]];
        codes[c] = CodeOfReflectance(below + cover * (color[c] - below));
      }
    }
  }
}

Eigen::Vector2d SquarePaint::PointAt(const Eigen::Vector2d& pixel) const {
  const double pixel_m = size_m_ / codes_.cols;
  return {pixel.x() * pixel_m - 0.5 * size_m_, 0.5 * size_m_ - pixel.y() * pixel_m};
}

void SquarePaint::Soil(double variation, std::uint64_t seed) {
  const cv::Mat noise = FractalNoise(codes_.size(), codes_.cols / 3.0, 5, 2.6, seed);
  for (int v = 0; v < codes_.rows; ++v) {
    for (int u = 0; u < codes_.cols; ++u) {
      const double factor = std::max(1 + variation * noise.at<float>(v, u), 0.0);
      codes_.at<cv::Vec3b>(v, u) *= std::sqrt(factor);
    }
  }
}

std::shared_ptr<const Texture> SquarePaint::ToTexture(int channels) const {
  return std::make_shared<Texture>(codes_, channels);
}

}  // namespace kestrel
