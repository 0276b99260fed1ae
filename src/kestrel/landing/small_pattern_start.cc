// SPDX-License-Identifier: BSD-3-Clause
// Where the fit of a small print starts: its size, then the direction of its arms.
#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "kestrel/landing/pattern_pose.h"
#include "kestrel/landing/small_pattern_model.h"

namespace kestrel {
namespace {

constexpr double kMinRingCorrelation = 0.2;  // of a start, ring and white alone

// The ring 'scale' times smaller: that much farther away.
CirclePose Shrunk(const CirclePose& ring, double scale) {
  return {ring.center / scale, ring.normal};
}

// Sums for the correlation of gray values with how dark a print is there.
class DarknessCorrelation {
 public:
  void Add(double gray, double dark) {
    ++n_;
    g_ += gray;
    gg_ += gray * gray;
    d_ += dark;
    dd_ += dark * dark;
    gd_ += gray * dark;
  }
  // 1 when the image is bright where the print is not dark; -1 without any contrast.
  double value() const {
    const double variance = (gg_ - g_ * g_ / n_) * (dd_ - d_ * d_ / n_);
    return variance > 0 ? -(gd_ - g_ * d_ / n_) / std::sqrt(variance) : -1;
  }

 private:
  double n_ = 0, g_ = 0, gg_ = 0, d_ = 0, dd_ = 0, gd_ = 0;
};

}  // namespace

// Darkness of the arm along 'along', metres.
double SmallPatternFitter::ArmDarkness(double along, double across, double blur_along,
                                       double blur_across) const {
  const double half_width = 0.5 * pattern_.arm_width_m;
  const double length = pattern_.arm_half_length_m;
  const auto step = [](double distance, double blur) { return BlurredStep(distance / blur).value; };
  const double width =
      step(across + half_width, blur_across) - step(across - half_width, blur_across);
  if (width <= 0) return 0;
  return width * (step(along + length, blur_along) - step(along - length, blur_along));
}

// Correlation of ring and white with the image when the ring lies as 'unturned'; fills the points
// of the workspace. The ring looks the same however it is turned.
double SmallPatternFitter::CorrelateRing(const RigidTransform& unturned,
                                         SmallPatternWorkspace* workspace) const {
  const PlaneMap map(unturned);
  const double inner = pattern_.inner_radius_m();
  workspace->points.clear();
  DarknessCorrelation correlation;
  for (const auto& pixel : workspace->pixels) {
    PlanePoint point = Intersect(map, pixel);
    const double r = std::max(point.radius(), 1e-9);
    const double blur_r =
        kGoodLensBlurPx *
        (point.by_pixel.transpose() * Eigen::Vector2d(point.x / r, point.y / r)).norm();
    point.ring = BlurredStroke(r, inner, pattern_.outer_radius_m(), blur_r).value;
    workspace->points.push_back(point);
    if (r > inner) correlation.Add(pixel.gray, point.ring);
  }
  return correlation.value();
}

// Correlation of the print with the image when it is turned by 'angle' in the plane of the points.
double SmallPatternFitter::CorrelatePrint(double angle,
                                          const SmallPatternWorkspace& workspace) const {
  const Eigen::Matrix2d turned = Eigen::Rotation2Dd(-angle).toRotationMatrix();
  DarknessCorrelation correlation;
  for (std::size_t i = 0; i < workspace.points.size(); ++i) {
    const PlanePoint& point = workspace.points[i];
    const Eigen::Vector2d place = turned * Eigen::Vector2d(point.x, point.y);
    const Eigen::Matrix2d by_pixel = turned * point.by_pixel;
    const double blur_x = kGoodLensBlurPx * by_pixel.row(0).norm();
    const double blur_y = kGoodLensBlurPx * by_pixel.row(1).norm();
    const double arms = (1 - ArmDarkness(place.x(), place.y(), blur_x, blur_y)) *
                        (1 - ArmDarkness(place.y(), place.x(), blur_y, blur_x));
    correlation.Add(workspace.pixels[i].gray, 1 - (1 - point.ring) * arms);
  }
  return correlation.value();
}

std::optional<double> SmallPatternFitter::FindScale(const cv::Mat& image, const CirclePose& ring,
                                                    std::span<const double> scales,
                                                    SmallPatternWorkspace* workspace) const {
  const auto look_at = [&](double scale) {
    const RigidTransform unturned = PatternPose(Shrunk(ring, scale), 0);
    return Gather(image, unturned, kEnoughToStart, workspace) ? CorrelateRing(unturned, workspace)
                                                              : -1.0;
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

SmallPatternFitter::Start SmallPatternFitter::FindStart(
    const CirclePose& ring, double scale, std::span<const double> arm_angles,
    const SmallPatternWorkspace& workspace) const {
  Start best{{}, -1};
  for (const double angle : arm_angles) {
    const double correlation = CorrelatePrint(angle, workspace);
    if (correlation > best.correlation) {
      best = {PatternPose(Shrunk(ring, scale), angle), correlation};
    }
  }
  return best;
}

}  // namespace kestrel
