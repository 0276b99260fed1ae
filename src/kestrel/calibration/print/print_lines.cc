// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/print/print_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

constexpr double kStep_px = 0.5;
constexpr float kLeastContrast = 20;  // contrast of white over black, gray values
constexpr double kSmoothing_px = 0.8;

// Samples the image along lines in the plane of the print.
class PrintLines {
 public:
  PrintLines(const cv::Mat& image, const CameraModel& camera,
             const RigidTransform& camera_from_target)
      : camera_(camera), pose_(camera_from_target) {
    cv::GaussianBlur(image, image_, cv::Size(), kSmoothing_px);
  }

  // Returns the pixel where a line that begins in black gets bright; nothing when it does not, or
  // when the image does not contain all of it.
  std::optional<Vector2d> FirstRise(const Vector2d& from, const Vector2d& to) {
    if (!Sample(from, to)) return std::nullopt;
    const float black = gray_.front();
    const float brightest = *std::max_element(gray_.begin(), gray_.end());
    if (brightest - black < kLeastContrast) return std::nullopt;
    const float half = 0.5f * (black + WhiteAbove(0.5f * (black + brightest)));
    for (std::size_t i = 1; i < gray_.size(); ++i) {
      if (gray_[i] < half) continue;
      const double part = (half - gray_[i - 1]) / (gray_[i] - gray_[i - 1]);
      return pixels_[i - 1] + part * (pixels_[i] - pixels_[i - 1]);
    }
    return std::nullopt;
  }

 private:
  bool Show(const Vector2d& point, Vector2d* pixel) const {
    return camera_.Project(pose_ * Eigen::Vector3d(point.x(), point.y(), 0), pixel) ==
           ProjectionStatus::kOk;
  }

  bool Sample(const Vector2d& from, const Vector2d& to) {
    Vector2d first, last;
    if (!Show(from, &first) || !Show(to, &last)) return false;
    const int steps = static_cast<int>((last - first).norm() / kStep_px);
    constexpr int kLeastSteps = 6;
    if (steps < kLeastSteps) return false;
    pixels_.clear();
    gray_.clear();
    for (int i = 0; i <= steps; ++i) {
      const double part = static_cast<double>(i) / steps;
      Vector2d pixel;
      if (!Show(from + part * (to - from), &pixel) || !IsInside(pixel)) return false;
      pixels_.push_back(pixel);
      gray_.push_back(GrayAt(pixel));
    }
    return true;
  }

  bool IsInside(const Vector2d& pixel) const {
    return pixel.minCoeff() >= 0 && pixel.x() < image_.cols - 1 && pixel.y() < image_.rows - 1;
  }

  float GrayAt(const Vector2d& pixel) const {
    const int x = static_cast<int>(pixel.x()), y = static_cast<int>(pixel.y());
    const auto u = static_cast<float>(pixel.x() - x), v = static_cast<float>(pixel.y() - y);
    const auto* upper = image_.ptr<std::uint8_t>(y) + x;
    const auto* lower = image_.ptr<std::uint8_t>(y + 1) + x;
    const auto mix = [](float a, float b, float part) { return a + part * (b - a); };
    return mix(mix(upper[0], upper[1], u), mix(lower[0], lower[1], u), v);
  }

  // Median of the values above 'least'.
  float WhiteAbove(float least) {
    sorted_.clear();
    std::copy_if(gray_.begin(), gray_.end(), std::back_inserter(sorted_),
                 [least](float gray) { return gray > least; });
    return MedianInPlace(sorted_);
  }

  const CameraModel& camera_;
  RigidTransform pose_;
  cv::Mat image_;
  std::vector<Vector2d> pixels_;
  std::vector<float> gray_, sorted_;
};

Vector2d Direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

// Finds edges across the circles, from the middle of the ring.
void FindCircles(const LandingPattern& pattern, PrintLines* lines,
                 std::vector<PrintLineEdge>* edges) {
  constexpr int kCount = 180;
  constexpr double kBeside = 0.35;  // rad from an arm, at which the white between arm and ring ends
  constexpr double kBeyond = 0.15;  // search range outside of the outer radius, relative to it
  const double middle = pattern.outer_radius_m() - 0.5 * pattern.ring_width_m;
  const double inside = 0.7 * pattern.inner_radius_m();
  for (int i = 0; i < kCount; ++i) {
    const double angle = 2 * kPi * (i + 0.5) / kCount;
    const Vector2d out = Direction(angle);
    // The sides of the board are at 45 degrees to the arms.
    const double from_side = std::remainder(angle - kPi / 4, kPi / 2);
    const double board = 0.5 * pattern.board_size_m / std::cos(from_side);
    const double outside = std::min((1 + kBeyond) * pattern.outer_radius_m(), 0.99 * board);
    if (const auto pixel = lines->FirstRise(middle * out, outside * out)) {
      edges->push_back({PrintLine::kOuterCircle, out, *pixel});
    }
    if (std::abs(std::remainder(angle, kPi / 2)) < kBeside) continue;
    if (const auto pixel = lines->FirstRise(middle * out, inside * out)) {
      edges->push_back({PrintLine::kInnerCircle, -out, *pixel});
    }
  }
}

// Finds edges across the sides of the arms, from their axes, and along the arms over their ends.
void FindArms(const LandingPattern& pattern, PrintLines* lines, std::vector<PrintLineEdge>* edges) {
  constexpr int kSides = 12, kEnds = 7;
  const double first = 1.8 * pattern.arm_width_m;
  const double last = 0.85 * pattern.arm_half_length_m;
  const double middle = pattern.outer_radius_m() - 0.5 * pattern.ring_width_m;
  for (int arm = 0; arm < 4; ++arm) {
    const Vector2d along = Direction(arm * kPi / 2);
    for (const double side : {1.0, -1.0}) {
      const Vector2d across = side * Vector2d(-along.y(), along.x());
      for (int i = 0; i < kSides && first < last; ++i) {
        const Vector2d base = (first + (last - first) * i / (kSides - 1)) * along;
        if (const auto pixel = lines->FirstRise(base, base + pattern.arm_width_m * across)) {
          edges->push_back({PrintLine::kArmSide, across, *pixel});
        }
      }
    }
    const Vector2d across(-along.y(), along.x());
    for (int i = 0; i < kEnds; ++i) {
      const double aside = 0.6 * pattern.arm_width_m * (static_cast<double>(i) / (kEnds - 1) - 0.5);
      const Vector2d from = 0.6 * pattern.arm_half_length_m * along + aside * across;
      if (const auto pixel = lines->FirstRise(from, middle * along + aside * across)) {
        edges->push_back({PrintLine::kArmEnd, along, *pixel});
      }
    }
  }
}

}  // namespace

std::vector<PrintLineEdge> FindPrintLineEdges(const cv::Mat& image, const CameraModel& camera,
                                              const RigidTransform& camera_from_target,
                                              const LandingPattern& pattern) {
  PrintLines lines(image, camera, camera_from_target);
  std::vector<PrintLineEdge> edges;
  FindCircles(pattern, &lines, &edges);
  FindArms(pattern, &lines, &edges);
  return edges;
}

}  // namespace kestrel
