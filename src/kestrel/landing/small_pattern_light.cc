// SPDX-License-Identifier: BSD-3-Clause
// The edge of a shadow on a small print.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kestrel/landing/small_pattern_model.h"

namespace kestrel {
namespace {

constexpr int kDirections = 12;        // over half a turn
constexpr double kOffsetStep = 0.1;    // of the extent
constexpr int kStrips = 64;            // over twice the extent, along the normal of an edge
constexpr double kMaxRemaining = 0.6;  // of the residual's square, by the edge
constexpr double kMaxDarkRatio = 0.8;  // of the light in the shadow to that beside it
constexpr double kMinDarkRatio = 0.05;

// Sums over what lies at one distance along the normal of an edge.
struct Strip {
  double reflected_squared = 0;
  double reflected_gray = 0;
};

// Sums of a fit of gray values by two lights, each on its side of an edge.
struct TwoLights {
  double aa = 0, ab = 0, bb = 0, ag = 0, bg = 0;

  // 'reflected': what is reflected of the light, squared and times the gray values. 'share': of the
  // light behind the edge.
  void Add(double reflected_squared, double reflected_gray, double share) {
    aa += reflected_squared * (1 - share) * (1 - share);
    ab += reflected_squared * (1 - share) * share;
    bb += reflected_squared * share * share;
    ag += reflected_gray * (1 - share);
    bg += reflected_gray * share;
  }
  // Light on either side; what of the squared gray values they explain.
  struct Solution {
    double before, behind, explained;
  };
  Solution Solve() const {
    const double determinant = aa * bb - ab * ab;
    if (determinant < 1e-6 * aa * bb + 1e-9) return {0, 0, 0};
    const double before = (bb * ag - ab * bg) / determinant;
    const double behind = (aa * bg - ab * ag) / determinant;
    return {before, behind, before * ag + behind * bg};
  }
};

}  // namespace

std::optional<SmallPatternFitter::ShadowEdge> SmallPatternFitter::FitShadowEdge(
    const State& state, const SmallPatternWorkspace& workspace) const {
  // What black reflects of the light that white does.
  const double blackness = std::clamp(state.contrast / state.white, 0.3, 0.95);
  const SmallPatternWorkspace::Points& points = workspace.points;
  const auto reflected_at = [&](std::size_t i) { return 1 - blackness * points.dark[i]; };
  double squares = 0, one_light = 0, one_norm = 0;
  for (std::size_t i = 0; i < workspace.count; ++i) {
    const double gray = workspace.pixels.gray[i];
    const double reflected = reflected_at(i);
    squares += gray * gray;
    one_light += reflected * gray;
    one_norm += reflected * reflected;
  }
  const double even_residual = squares - one_light * one_light / one_norm;

  ShadowEdge best;
  double best_residual = kMaxRemaining * even_residual;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = i * std::numbers::pi / kDirections;
    ShadowEdge edge{{std::cos(angle), std::sin(angle)}, 0, 1, 1};
    // All edges of a direction have the same distances from the points: those are summed up first.
    std::array<Strip, kStrips> strips{};
    for (std::size_t k = 0; k < workspace.count; ++k) {
      const double reflected = reflected_at(k);
      const double distance = edge.normal.dot(Eigen::Vector2d(points.x[k], points.y[k]));
      const auto at = static_cast<int>((distance / extent_m_ + 1) * (0.5 * kStrips));
      Strip& strip = strips[std::clamp(at, 0, kStrips - 1)];
      strip.reflected_squared += reflected * reflected;
      strip.reflected_gray += reflected * workspace.pixels.gray[k];
    }
    for (int step = -8; step <= 8; ++step) {
      edge.offset = step * kOffsetStep * extent_m_;
      TwoLights lights;
      for (int k = 0; k < kStrips; ++k) {
        const double distance = ((k + 0.5) / (0.5 * kStrips) - 1) * extent_m_;
        lights.Add(strips[k].reflected_squared, strips[k].reflected_gray,
                   ShadowEdge::ShareAt(distance - edge.offset));
      }
      const TwoLights::Solution solution = lights.Solve();
      const double residual = squares - solution.explained;
      const double darker = std::min(solution.before, solution.behind);
      const double brighter = std::max(solution.before, solution.behind);
      if (residual >= best_residual || darker < kMinDarkRatio * brighter ||
          darker > kMaxDarkRatio * brighter) {
        continue;
      }
      best_residual = residual;
      edge.before = darker / solution.before;
      edge.behind = darker / solution.behind;
      best = edge;
    }
  }
  if (best.normal.isZero()) return std::nullopt;
  return best;
}

// Takes from the gray values of the workspace what the light beside a shadow adds to them. False
// when there is no such edge.
bool SmallPatternFitter::EvenOut(SmallPatternWorkspace* workspace, State* state) const {
  const std::optional<ShadowEdge> edge = FitShadowEdge(*state, *workspace);
  if (!edge) return false;
  state->edge = *edge;
  for (std::size_t i = 0; i < workspace->count; ++i) {
    const double factor = edge->Factor(workspace->points.x[i], workspace->points.y[i]);
    workspace->pixels.gray[i] *= static_cast<float>(factor);
  }
  MeasureLevels(*workspace, state);
  return state->contrast >= kMinContrast;
}

}  // namespace kestrel
