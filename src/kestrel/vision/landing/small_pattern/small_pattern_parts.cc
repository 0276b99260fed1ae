// SPDX-License-Identifier: BSD-3-Clause
// The share of the print's contrast that each part of a small print has.
#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "kestrel/vision/landing/small_pattern/small_pattern_model.h"

namespace kestrel {
namespace {

constexpr double kMaxHighlight = 0.25;  // largest share around a visible arm

}  // namespace

// Sums over the pixels for the parts of a print: 4 quarters of the ring, 4 half arms, 4 quadrants,
// then white and its slopes.
struct SmallPatternFitter::Parts {
  static constexpr int kArms = LandingPattern::kArms;
  static constexpr int kRing = 0;
  static constexpr int kArm = kRing + kArms;
  static constexpr int kQuadrant = kArm + kArms;
  static constexpr int kLight = kQuadrant + kArms;
  static constexpr int kParts = kLight + 3;
  // Number of parts with a share in one pixel: a ring, an arm, a quadrant, three of the light.
  static constexpr std::size_t kOfPixel = 6;
  using Vector = Eigen::Matrix<double, kParts, 1>;
  using Matrix = Eigen::Matrix<double, kParts, kParts>;

  // 'seen': gray value. 'pixel_area': m^2.
  void Add(const std::array<int, kOfPixel>& part, const std::array<double, kOfPixel>& share,
           double seen, double pixel_area) {
    for (std::size_t k = 0; k < 3; ++k) area[part[k]] += share[k] * pixel_area;
    for (std::size_t row = 0; row < part.size(); ++row) {
      b(part[row]) += share[row] * seen;
      for (std::size_t column = 0; column <= row; ++column) {
        h(part[row], part[column]) += share[row] * share[column];
      }
    }
  }

  // Regularization: a part out of view gets no amplitude instead of a wild one.
  Vector Amplitudes() {
    for (int i = 0; i < kParts; ++i) h(i, i) += 1e-3 + 0.002 * h(i, i);
    return h.selfadjointView<Eigen::Lower>().ldlt().solve(b);
  }

  // A part with less than a third of the area in view of the best-seen one of its kind is not
  // judged.
  bool IsSeen(int kind, int k) const {
    return 3 * area[kind + k] >= *std::max_element(&area[kind], &area[kind] + 4);
  }
  // Nor is an arm in a highlight: a missing arm is white, and not brighter than that.
  bool IsArmSeen(int k) const {
    return IsSeen(kArm, k) && highlight[k] <= kMaxHighlight * inside[k];
  }

  Matrix h = Matrix::Zero();
  Vector b = Vector::Zero();
  std::array<int, 4> highlight{}, inside{};  // pixels per quarter
  std::array<double, kLight> area{};         // area of the print's parts in view, m^2
};

SmallPatternFitter::Parts SmallPatternFitter::SumParts(const SmallPatternWorkspace& workspace,
                                                       const State& state) const {
  Parts parts;
  const double inner = pattern_.inner_radius_m();
  const SmallPatternWorkspace::Points& points = workspace.points;
  for (std::size_t i = 0; i < workspace.count; ++i) {
    const double x = points.x[i], y = points.y[i], ring = points.ring[i];
    const double gray = workspace.pixels.gray[i], expected = points.expected[i];
    const int quarter = std::abs(x) > std::abs(y) ? (x > 0 ? 0 : 2) : (y > 0 ? 1 : 3);
    const bool is_inside = x * x + y * y < inner * inner;
    if (is_inside) {
      ++parts.inside[quarter];
      parts.highlight[quarter] += gray > state.White(x, y) + state.Highlight();
    }
    // A saturated pixel where the print should be darker is taken for white.
    const double seen = gray < kSaturatedGray ? gray
                        : expected <= gray    ? std::max(state.white, gray)
                                              : expected;
    const double arm = std::max(points.arm_x[i], points.arm_y[i]) * (1 - ring);
    const double white = is_inside ? 1 - points.dark[i] : 0.0;
    const double pixel_area = std::abs(points.x_by_u[i] * points.y_by_v[i] -  //
                                       points.x_by_v[i] * points.y_by_u[i]);
    parts.Add({Parts::kRing + quarter, Parts::kArm + quarter, Parts::kQuadrant + QuadrantOf(x, y),
               Parts::kLight, Parts::kLight + 1, Parts::kLight + 2},
              {ring, arm, white, 1, x, y}, seen, pixel_area);
  }
  return parts;
}

// Fits amplitudes to the ring's quarters, to each half arm and to the white of each quadrant, on
// top of white that may vary linearly over the print, and compares them with the print's contrast.
PartShares SmallPatternFitter::MeasureParts(const SmallPatternWorkspace& workspace,
                                            const State& state) const {
  Parts parts = SumParts(workspace, state);
  const Parts::Vector amplitude = parts.Amplitudes();
  const auto share = [&](int part) {
    return std::clamp(-amplitude(part) / state.contrast, 0.0, 1.0);
  };
  PartShares shares;
  for (int k = 0; k < Parts::kArms; ++k) {
    shares.ring[k] = parts.IsSeen(Parts::kRing, k) ? share(Parts::kRing + k) : -1;
    shares.arm[k] = parts.IsArmSeen(k) ? share(Parts::kArm + k) : -1;
  }
  return shares;
}

}  // namespace kestrel
