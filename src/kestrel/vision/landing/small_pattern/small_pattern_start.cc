// SPDX-License-Identifier: BSD-3-Clause
// The start of the fit of a small print: its size, then the direction of its arms.
#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "kestrel/vision/landing/image_properties.h"
#include "kestrel/vision/landing/location/pattern_pose.h"
#include "kestrel/vision/landing/small_pattern/small_pattern_model.h"

namespace kestrel {
namespace {

constexpr double kMinRingCorrelation = 0.2;  // with ring and white alone

// The ring 'scale' times smaller, hence that much farther away.
CirclePose Shrunk(const CirclePose& ring, double scale) {
  return {ring.center / scale, ring.normal};
}

// Returns the correlation of the image with the predicted ring and the white around it, which do
// not depend on the turn of the pattern.
double CorrelateRing(const LandingPattern& pattern, const SmallPatternWorkspace& workspace) {
  const auto inner = static_cast<float>(pattern.inner_radius_m());
  const SmallPatternWorkspace::Points& points = workspace.points;
  Correlation with_dark;
  for (std::size_t i = 0; i < workspace.count; ++i) {
    const float x = points.x[i], y = points.y[i];
    if (x * x + y * y > inner * inner) {
      with_dark.Add(workspace.pixels.gray[i], points.ring[i]);
    }
  }
  return -with_dark.value();
}

}  // namespace

std::optional<double> SmallPatternFitter::FindScale(const cv::Mat& image, const CirclePose& ring,
                                                    std::span<const double> scales,
                                                    SmallPatternWorkspace* workspace) const {
  const auto look_at = [&](double scale) {
    const RigidTransform unturned = PatternPose(Shrunk(ring, scale), 0);
    if (!Gather(image, unturned, kEnoughPixels / 2, workspace)) return -1.0;
    Predict(unturned, LensBlur::kGoodPx, workspace);
    return CorrelateRing(pattern_, *workspace);
  };
  double best = 0, best_correlation = kMinRingCorrelation;
  for (const double scale : scales) {
    const double correlation = look_at(scale);
    if (correlation < best_correlation) continue;
    best_correlation = correlation;
    best = scale;
  }
  if (best == 0) return std::nullopt;
  if (best != scales.back()) look_at(best);
  return best;
}

SmallPatternFitter::Start SmallPatternFitter::FindStart(const CirclePose& ring, double scale,
                                                        std::span<const double> arm_angles,
                                                        SmallPatternWorkspace* workspace) const {
  Start best{{}, -1};
  for (const double angle : arm_angles) {
    const RigidTransform pose = PatternPose(Shrunk(ring, scale), angle);
    Predict(pose, LensBlur::kGoodPx, workspace);
    const double correlation = CorrelatePrint(*workspace);
    if (correlation > best.correlation) best = {pose, correlation};
  }
  return best;
}

}  // namespace kestrel
