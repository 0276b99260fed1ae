// SPDX-License-Identifier: BSD-3-Clause
// What tells other signs from a small print.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "kestrel/image/gray_sampling.h"
#include "kestrel/landing/small_pattern_model.h"

namespace kestrel {

std::optional<SmallPatternFitter::OtherSigns> SmallPatternFitter::Inspect(
    const cv::Mat& image, const RigidTransform& pose, Light light,
    SmallPatternWorkspace* workspace) const {
  if (!Gather(image, pose, kEnoughToInspect, workspace)) return std::nullopt;
  State state;
  state.pose = pose;
  Predict(state, workspace);
  MeasureLevels(*workspace, &state);
  if (state.contrast < kMinContrast) return std::nullopt;
  if (light == Light::kShadowEdge && !EvenOut(workspace, &state)) return std::nullopt;
  return MeasureOthers(image, state, workspace);
}

// Of a print that is predicted.
SmallPatternFitter::OtherSigns SmallPatternFitter::MeasureOthers(
    const cv::Mat& image, const State& state, SmallPatternWorkspace* workspace) const {
  for (std::size_t i = 0; i < workspace->points.size(); ++i) {
    PlanePoint& point = workspace->points[i];
    point.expected = state.Gray(point, point.dark);
    point.gray = state.WithoutHighlight(point, SeenGray(workspace->pixels[i].gray, point.expected));
  }
  return {.spokes = OtherSpokes(*workspace, state),
          .frame_corners = FrameCorners(*workspace, state),
          .cross_correlation = CrossCorrelation(*workspace),
          .board_darkness = BoardDarkness(image, state)};
}

// In each quadrant the darkest line from the centre among those well away from the arms: its depth
// in what the fit left over, against the rest of the quadrant.
double SmallPatternFitter::OtherSpokes(const SmallPatternWorkspace& workspace,
                                       const State& state) const {
  constexpr std::array<double, 3> kTurns{33, 45, 57};  // degrees from the arm before
  struct Regression {
    double n = 0, s = 0, ss = 0, e = 0, se = 0;
  };
  std::array<std::array<Regression, kTurns.size()>, 4> lines;
  std::array<std::array<Eigen::Vector2d, kTurns.size()>, 4> normals;
  for (int q = 0; q < 4; ++q) {
    for (std::size_t i = 0; i < kTurns.size(); ++i) {
      const double angle = (90 * q + kTurns[i]) * std::numbers::pi / 180;
      normals[q][i] = {-std::sin(angle), std::cos(angle)};
    }
  }
  const double inner = pattern_.inner_radius_m();
  const double half_width = 0.5 * pattern_.arm_width_m;
  for (const PlanePoint& point : workspace.points) {
    const double radius = point.radius();
    if (radius < 0.35 * inner || radius > 0.9 * inner) continue;
    const double residual = point.gray - point.expected;
    const int quadrant = QuadrantOf(point);
    for (std::size_t i = 0; i < kTurns.size(); ++i) {
      const Eigen::Vector2d& normal = normals[quadrant][i];
      const double distance = normal.dot(Eigen::Vector2d(point.x, point.y));
      const double blur = state.blur_px * (point.by_pixel.transpose() * normal).norm();
      const double line =
          BlurredStroke(distance, -half_width, half_width, std::max(blur, 1e-9)).value;
      Regression& r = lines[quadrant][i];
      ++r.n;
      r.s += line;
      r.ss += line * line;
      r.e += residual;
      r.se += line * residual;
    }
  }
  std::array<double, 4> darkest{};
  for (int q = 0; q < 4; ++q) {
    for (const Regression& r : lines[q]) {
      const double spread = r.ss - r.s * r.s / std::max(r.n, 1.0);
      if (r.n < 6 || spread < 0.3) continue;
      darkest[q] = std::max(darkest[q], -(r.se - r.s * r.e / r.n) / spread / state.contrast);
    }
  }
  std::sort(darkest.begin(), darkest.end(), std::greater<>());
  return darkest[1];
}

// How much darker the white is beyond the ends of the arms than between them.
double SmallPatternFitter::FrameCorners(const SmallPatternWorkspace& workspace,
                                        const State& state) const {
  double n = 0, s = 0, ss = 0, e = 0, se = 0;
  for (const PlanePoint& point : workspace.points) {
    const double radius = point.radius();
    if (radius < pattern_.inner_radius_m()) continue;
    const double residual = point.gray - point.expected;
    // 1 along the arms, -1 half-way between them: the cosine of four times the direction.
    const double twice = (point.x * point.x - point.y * point.y) / (radius * radius);
    const double wave = 2 * twice * twice - 1;
    ++n;
    s += wave;
    ss += wave * wave;
    e += residual;
    se += wave * residual;
  }
  const double spread = ss - s * s / std::max(n, 1.0);
  return spread > 1 ? -(se - s * e / n) / spread / state.contrast : 0;
}

double SmallPatternFitter::CrossCorrelation(const SmallPatternWorkspace& workspace) const {
  double n = 0, g = 0, gg = 0, d = 0, dd = 0, gd = 0;
  for (const PlanePoint& point : workspace.points) {
    if (point.radius() > pattern_.arm_half_length_m) continue;
    ++n;
    g += point.gray;
    gg += point.gray * point.gray;
    d += point.expected;
    dd += point.expected * point.expected;
    gd += point.gray * point.expected;
  }
  const double variance = (gg - g * g / n) * (dd - d * d / n);
  return n > 0 && variance > 0 ? (gd - g * d / n) / std::sqrt(variance) : 0;
}

// The median over the directions in view: a white ring on dark ground has no board.
double SmallPatternFitter::BoardDarkness(const cv::Mat& image, const State& state) const {
  constexpr int kDirections = 24;
  std::array<double, kDirections> darkness;
  int seen = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = i * 2 * std::numbers::pi / kDirections;
    const Eigen::Vector3d point(board_radius_m_ * std::cos(angle),
                                board_radius_m_ * std::sin(angle), 0);
    Eigen::Vector2d pixel;
    if (camera_.Project(state.pose * point, &pixel) == ProjectionStatus::kOutsideModel) continue;
    const float seen_gray =
        SampleGray(image, static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
    if (seen_gray < 0) continue;
    const double gray = seen_gray * state.edge.Factor(point.x(), point.y());
    const double white = state.White({point.x(), point.y(), {}});
    darkness[seen++] = seen_gray >= kSaturated ? 0 : (white - gray) / state.contrast;
  }
  if (seen == 0) return 0;
  std::nth_element(darkness.begin(), darkness.begin() + seen / 2, darkness.begin() + seen);
  return darkness[seen / 2];
}

}  // namespace kestrel
