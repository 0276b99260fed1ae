// SPDX-License-Identifier: BSD-3-Clause
// Signs that distinguish other figures from a small print.
#include <algorithm>

#include "kestrel/vision/landing/small_pattern/small_pattern_model.h"

namespace kestrel {

// Returns how much darker the white is beyond the ends of the arms than between them, in contrasts.
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

}  // namespace kestrel
