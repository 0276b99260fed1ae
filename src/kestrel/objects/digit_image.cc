// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/objects/digit_image.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "kestrel/objects/otsu.h"

namespace kestrel {
namespace {

constexpr int kFaceSide = 48;
constexpr int kMargin = 4;  // where the ground shines in
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

// Where the figure is and how far its pixels are from its middle (root of the mean square).
struct Figure {
  int threshold;
  Eigen::Vector2d middle;
  double radius;
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
  double squares = 0;
  for_inside([&](int column, int row, std::uint8_t value) {
    if (value <= split.threshold) return;
    const Eigen::Vector2d at(column, row);
    ++count;
    sum += at;
    squares += at.squaredNorm();
  });
  if (count < kMinShare * kInside || count > kMaxShare * kInside) return std::nullopt;
  const Eigen::Vector2d middle = sum / count;
  return Figure{split.threshold, middle,
                std::sqrt(std::max(1.0, squares / count - middle.squaredNorm()))};
}

}  // namespace

std::optional<DigitImage> CutOutDigit(const cv::Mat& image, const FaceCorners& corners) {
  // The image reaches this many radii from the figure's middle: a digit fits in.
  constexpr double kReach = 1.8;
  const FaceImage face = MapFace(image, corners);
  const std::optional<Figure> figure = FindFigure(face);
  if (!figure) return std::nullopt;
  const double step = 2 * kReach * figure->radius / kDigitSide;
  DigitImage digit;
  for (int row = 0; row < kDigitSide; ++row) {
    for (int column = 0; column < kDigitSide; ++column) {
      const Eigen::Vector2d at =
          figure->middle +
          step * Eigen::Vector2d(column - 0.5 * (kDigitSide - 1), row - 0.5 * (kDigitSide - 1));
      const auto x = static_cast<int>(std::lround(at.x()));
      const auto y = static_cast<int>(std::lround(at.y()));
      const bool is_inside = x >= kMargin / 2 && y >= kMargin / 2 && x < kFaceSide - kMargin / 2 &&
                             y < kFaceSide - kMargin / 2;
      digit[row * kDigitSide + column] =
          is_inside && face[y * kFaceSide + x] > figure->threshold ? 1 : 0;
    }
  }
  return digit;
}

DigitImage QuarterTurn(const DigitImage& digit) {
  DigitImage turned;
  for (int row = 0; row < kDigitSide; ++row) {
    for (int column = 0; column < kDigitSide; ++column) {
      turned[column * kDigitSide + (kDigitSide - 1 - row)] = digit[row * kDigitSide + column];
    }
  }
  return turned;
}

}  // namespace kestrel
