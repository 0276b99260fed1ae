// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/digits/digit_image.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "kestrel/vision/objects/shapes/otsu.h"

namespace kestrel {
namespace {

constexpr int kFaceSide = 48;
constexpr int kMargin = 4;  // where the ground may shine in
using FaceImage = std::array<std::uint8_t, kFaceSide * kFaceSide>;

// Maps (0, 0), (1, 0), (1, 1), (0, 1) to the corners.
Eigen::Matrix3d HomographyToCorners(const FaceCorners& corners) {
  const Eigen::Vector2d d1 = corners[1] - corners[2];
  const Eigen::Vector2d d2 = corners[3] - corners[2];
  const Eigen::Vector2d sum = corners[0] - corners[1] + corners[2] - corners[3];
  Eigen::Matrix2d m;
  m << d1, d2;
  const Eigen::Vector2d g = m.inverse() * sum;
  Eigen::Matrix3d h;
  h.row(2) << g.x(), g.y(), 1;
  h.topLeftCorner<2, 1>() = corners[1] - corners[0] + g.x() * corners[1];
  h.block<2, 1>(0, 1) = corners[3] - corners[0] + g.y() * corners[3];
  h.topRightCorner<2, 1>() = corners[0];
  return h;
}

double LeastChannel(const cv::Mat& image, int u, int v) {
  const std::uint8_t* bgr = image.ptr(std::clamp(v, 0, image.rows - 1)) +
                            3 * static_cast<std::ptrdiff_t>(std::clamp(u, 0, image.cols - 1));
  return std::min({bgr[0], bgr[1], bgr[2]});
}

double SampleLeastChannel(const cv::Mat& image, const Eigen::Vector2d& at) {
  const int u = static_cast<int>(std::floor(at.x()));
  const int v = static_cast<int>(std::floor(at.y()));
  const double x = at.x() - u;
  const double y = at.y() - v;
  return (1 - y) * ((1 - x) * LeastChannel(image, u, v) + x * LeastChannel(image, u + 1, v)) +
         y * ((1 - x) * LeastChannel(image, u, v + 1) + x * LeastChannel(image, u + 1, v + 1));
}

FaceImage MapFace(const cv::Mat& image, const FaceCorners& corners) {
  const Eigen::Matrix3d pixel_from_face = HomographyToCorners(corners);
  FaceImage face;
  for (int row = 0; row < kFaceSide; ++row) {
    for (int column = 0; column < kFaceSide; ++column) {
      const Eigen::Vector3d pixel =
          pixel_from_face * Eigen::Vector3d((column + 0.5) / kFaceSide, (row + 0.5) / kFaceSide, 1);
      face[row * kFaceSide + column] = static_cast<std::uint8_t>(
          std::lround(SampleLeastChannel(image, pixel.head<2>() / pixel.z())));
    }
  }
  return face;
}

// The bright pixels: threshold and contrast against the paint, centroid and covariance.
struct Figure {
  double threshold;
  double contrast;
  Eigen::Vector2d middle;
  Eigen::Matrix2d covariance;
};

std::optional<Figure> FindFigure(const FaceImage& face) {
  constexpr double kMinContrast = 25;
  constexpr double kMinShare = 0.02;
  constexpr double kMaxShare = 0.45;
  constexpr double kInside = (kFaceSide - 2.0 * kMargin) * (kFaceSide - 2.0 * kMargin);
  Histogram histogram{};
  const auto for_inside = [&](const auto& visit) {
    for (int row = kMargin; row < kFaceSide - kMargin; ++row) {
      for (int column = kMargin; column < kFaceSide - kMargin; ++column) {
        visit(column, row, face[row * kFaceSide + column]);
      }
    }
  };
  for_inside([&](int, int, std::uint8_t value) { ++histogram[value]; });
  const OtsuSplit split = SplitByOtsu(histogram);
  if (split.upper_mean - split.lower_mean < kMinContrast) return std::nullopt;
  double count = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  for_inside([&](int column, int row, std::uint8_t value) {
    if (value <= split.threshold) return;
    const Eigen::Vector2d at(column, row);
    ++count;
    sum += at;
    squares += at * at.transpose();
  });
  if (count < kMinShare * kInside || count > kMaxShare * kInside) return std::nullopt;
  const Eigen::Vector2d middle = sum / count;
  return Figure{static_cast<double>(split.threshold), split.upper_mean - split.lower_mean, middle,
                squares / count - middle * middle.transpose()};
}

// Returns the share of the figure in a point of the face, 0 to 1.
float ShareAt(const FaceImage& face, const Figure& figure, const Eigen::Vector2d& at) {
  const double edge = 0.5 * kMargin;
  if (at.minCoeff() < edge || at.maxCoeff() >= kFaceSide - 1 - edge) return 0;
  const auto u = static_cast<int>(at.x());
  const auto v = static_cast<int>(at.y());
  const double x = at.x() - u;
  const double y = at.y() - v;
  const std::uint8_t* upper = &face[v * kFaceSide + u];
  const std::uint8_t* lower = upper + kFaceSide;
  const double value =
      (1 - y) * ((1 - x) * upper[0] + x * upper[1]) + y * ((1 - x) * lower[0] + x * lower[1]);
  const double share = 0.5 + (value - figure.threshold) / figure.contrast;
  return static_cast<float>(std::clamp(share, 0.0, 1.0));
}

// Returns the figure with its foot in the direction of 'down'.
DigitImage ViewFigure(const FaceImage& face, const Figure& figure, const Eigen::Vector2d& down) {
  // Half the side of the image, in radii of the figure: a digit fits in.
  constexpr double kRadiiShown = 1.8;
  constexpr double kMaxSlant = 0.5;
  constexpr double kMinVariance = 0.5;
  const Eigen::Vector2d right(down.y(), -down.x());
  const double height = std::max(kMinVariance, down.dot(figure.covariance * down));
  const double lean = right.dot(figure.covariance * down);
  const double slant = std::clamp(lean / height, -kMaxSlant, kMaxSlant);
  const double width = std::max(
      kMinVariance, right.dot(figure.covariance * right) - slant * (2 * lean - slant * height));
  // As wide as high, because fonts are narrow or wide.
  const double step = 2 * kRadiiShown * std::sqrt(width + height) / kDigitSide;
  const double stretch = std::pow(width / height, 0.25);
  DigitImage digit;
  for (int row = 0; row < kDigitSide; ++row) {
    for (int column = 0; column < kDigitSide; ++column) {
      const double x = step * stretch * (column - 0.5 * (kDigitSide - 1));
      const double y = step / stretch * (row - 0.5 * (kDigitSide - 1));
      digit[row * kDigitSide + column] =
          ShareAt(face, figure, figure.middle + (x + slant * y) * right + y * down);
    }
  }
  return digit;
}

}  // namespace

std::optional<DigitViews> CutOutDigit(const cv::Mat& image, const FaceCorners& corners) {
  const FaceImage face = MapFace(image, corners);
  const std::optional<Figure> figure = FindFigure(face);
  if (!figure) return std::nullopt;
  DigitViews views;
  Eigen::Vector2d down = Eigen::Vector2d::UnitY();
  for (DigitImage& view : views) {
    view = ViewFigure(face, *figure, down);
    down = {down.y(), -down.x()};
  }
  return views;
}

}  // namespace kestrel
