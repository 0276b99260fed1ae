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

// Of a print that is predicted and compared with the image.
SmallPatternFitter::OtherSigns SmallPatternFitter::MeasureOthers(
    const MaskedImage& image, const State& state, SmallPatternWorkspace* workspace) const {
  return {.spokes = OtherSpokes(state, workspace),
          .frame_corners = FrameCorners(*workspace, state),
          .cross_correlation = CrossCorrelation(*workspace, state),
          .board_darkness = BoardDarkness(image, state, workspace)};
}

// In each quadrant the darkest line from the centre among those well away from the arms: its depth
// in what the fit left over, against the rest of the quadrant.
double SmallPatternFitter::OtherSpokes(const State& state, SmallPatternWorkspace* workspace) const {
  constexpr std::size_t kLines = SmallPatternWorkspace::kLines;
  constexpr std::array<double, kLines> kTurns{33, 45, 57};  // degrees from the arm before
  std::array<std::array<float, 2>, kLines> normals;
  for (std::size_t i = 0; i < kLines; ++i) {
    const double angle = kTurns[i] * std::numbers::pi / 180;
    normals[i] = {static_cast<float>(-std::sin(angle)), static_cast<float>(std::cos(angle))};
  }
  EvaluateLines(ModelOf(pattern_, state.pose, state.blur_px), normals, workspace);
  struct Regression {
    double n = 0, s = 0, ss = 0, e = 0, se = 0;
  };
  std::array<std::array<Regression, kLines>, 4> lines;
  const double inner = pattern_.inner_radius_m();
  const double least = 0.35 * inner * 0.35 * inner, most = 0.9 * inner * 0.9 * inner;
  const SmallPatternWorkspace::Points& points = workspace->points;
  for (std::size_t i = 0; i < workspace->count; ++i) {
    const double x = points.x[i], y = points.y[i];
    const double squared_radius = x * x + y * y;
    if (squared_radius < least || squared_radius > most) continue;
    const double residual = points.seen[i] - points.expected[i];
    std::array<Regression, kLines>& quadrant = lines[QuadrantOf(x, y)];
    for (std::size_t k = 0; k < kLines; ++k) {
      const double line = workspace->lines[k][i];
      Regression& r = quadrant[k];
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
  const double outer = pattern_.outer_radius_m();
  const SmallPatternWorkspace::Points& points = workspace.points;
  for (std::size_t i = 0; i < workspace.count; ++i) {
    const double xx = points.x[i] * points.x[i], yy = points.y[i] * points.y[i];
    if (xx + yy < outer * outer) continue;
    const double residual = points.seen[i] - points.expected[i];
    // 1 along the arms, -1 half-way between them: the cosine of four times the direction.
    const double twice = (xx - yy) / (xx + yy);
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

double SmallPatternFitter::CrossCorrelation(const SmallPatternWorkspace& workspace,
                                            const State& state) const {
  const double reach = pattern_.arm_half_length_m;
  const SmallPatternWorkspace::Points& points = workspace.points;
  Correlation with_expected;
  for (std::size_t i = 0; i < workspace.count; ++i) {
    const double x = points.x[i], y = points.y[i];
    if (x * x + y * y <= reach * reach) with_expected.Add(points.seen[i], points.expected[i]);
  }
  return with_expected.value(state.noise_variance);
}

// How much darker than expected the darkest of the white inside of the ring is, noise left aside:
// a highlight on the rest makes the fit expect more.
double SmallPatternFitter::WhiteDarkness(const State& state,
                                         SmallPatternWorkspace* workspace) const {
  constexpr float kWhite = 0.3f;     // darkness by the print
  constexpr double kDarkest = 0.15;  // quantile
  const double inner = pattern_.inner_radius_m();
  const SmallPatternWorkspace::Points& points = workspace->points;
  SmallPatternWorkspace::Column& residuals = workspace->magnitudes;
  std::size_t count = 0;
  for (std::size_t i = 0; i < workspace->count; ++i) {
    if (points.dark[i] > kWhite || std::hypot(points.x[i], points.y[i]) > inner) continue;
    residuals[count++] = points.seen[i] - points.expected[i];
  }
  return count == 0 ? 0 : -Quantile(kDarkest, count, &residuals) / state.contrast;
}

// The median over the directions in view, beyond the darkest white of the print: a white ring on
// dark ground has no board.
double SmallPatternFitter::BoardDarkness(const MaskedImage& image, const State& state,
                                         SmallPatternWorkspace* workspace) const {
  std::array<double, kBoardDirections> darkness;
  int seen = 0;
  for (int i = 0; i < kBoardDirections; ++i) {
    const double angle = i * 2 * std::numbers::pi / kBoardDirections;
    const Eigen::Vector3d point(board_radius_m_ * std::cos(angle),
                                board_radius_m_ * std::sin(angle), 0);
    Eigen::Vector2d pixel;
    if (camera_.Project(state.pose * point, &pixel) == ProjectionStatus::kOutsideModel) continue;
    const auto x = static_cast<float>(pixel.x()), y = static_cast<float>(pixel.y());
    const float seen_gray = SampleGray(image.gray, x, y);
    if (seen_gray < 0 || (image.seen && SampleGray(*image.seen, x, y) < 255)) continue;
    const double gray = seen_gray * state.board_factor[i];
    const double white = state.White(point.x(), point.y());
    darkness[seen++] = seen_gray >= kSaturatedGray ? 0 : (white - gray) / state.contrast;
  }
  if (seen == 0) return 0;
  std::nth_element(darkness.begin(), darkness.begin() + seen / 2, darkness.begin() + seen);
  return darkness[seen / 2] - WhiteDarkness(state, workspace);
}

}  // namespace kestrel
