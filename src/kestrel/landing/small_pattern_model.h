// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The model of a small print that its fit and its tests share; nothing that others need.

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/LU>

#include "kestrel/geometry/rigid_transform.h"
#include "kestrel/landing/small_pattern.h"

namespace kestrel {

inline constexpr double kGoodLensBlurPx = 0.7;  // of optics and pixels, standard deviation
inline constexpr double kMinContrast = 2;       // gray values
inline constexpr double kSaturated = 254;
// Pixels of a box around a print beyond which some may be left out.
inline constexpr int kEnoughToFit = 1200;
inline constexpr int kEnoughToStart = 600;
inline constexpr int kEnoughToInspect = 600;

// A gray value where the image cuts off what is brighter: then it is what is expected.
inline double SeenGray(double gray, double expected) {
  return gray >= kSaturated && expected > gray ? expected : gray;
}

// Blurred step from 0 to 1 over a distance in units of the blur's standard deviation: the integral
// of the biweight kernel of variance one, which is near to a Gaussian and ends at 2.65.
struct Step {
  double value;
  double slope;
};
inline Step BlurredStep(double z) {
  constexpr double kReach = 2.6457513110645906;  // sqrt(7)
  const double t = std::clamp(z / kReach, -1.0, 1.0);
  const double square = t * t;
  const double rest = 1 - square;
  return {0.5 + t * (15.0 / 16 - square * (10.0 / 16 - square * 3.0 / 16)),
          15.0 / 16 * rest * rest / kReach};
}

// A blurred stroke: where a distance lies between two limits.
struct Stroke {
  double value = 0;
  double by_distance = 0;  // derivative
  double by_log_blur = 0;
};
inline Stroke BlurredStroke(double distance, double low, double high, double blur) {
  const double z_low = (distance - low) / blur;
  const double z_high = (distance - high) / blur;
  const Step a = BlurredStep(z_low);
  const Step b = BlurredStep(z_high);
  return {a.value - b.value, (a.slope - b.slope) / blur, b.slope * z_high - a.slope * z_low};
}

// Where rays meet the plane of a pose.
struct PlaneMap {
  explicit PlaneMap(const RigidTransform& camera_from_pattern)
      : rotation(camera_from_pattern.rotation.toRotationMatrix()),
        translation(camera_from_pattern.translation) {
    Eigen::Matrix3d basis;
    basis << rotation.col(0), rotation.col(1), translation;
    inverse = basis.inverse();
  }
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  Eigen::Matrix3d inverse;  // ray to homogeneous plane coordinates
};

using PlanePoint = SmallPatternWorkspace::PlanePoint;

// Quadrant between the arms, from x to y.
inline int QuadrantOf(const PlanePoint& point) {
  return point.x > 0 ? (point.y > 0 ? 0 : 3) : (point.y > 0 ? 1 : 2);
}

inline PlanePoint Intersect(const PlaneMap& map, const SmallPatternWorkspace::Pixel& pixel) {
  const Eigen::Vector3d h = map.inverse * pixel.ray;
  const Eigen::Vector3d hu = map.inverse * pixel.d_ray_du;
  const Eigen::Vector3d hv = map.inverse * pixel.d_ray_dv;
  const double w = 1 / h.z();
  PlanePoint point{h.x() * w, h.y() * w, {}};
  point.by_pixel << (hu.x() - point.x * hu.z()) * w, (hv.x() - point.x * hv.z()) * w,
      (hu.y() - point.y * hu.z()) * w, (hv.y() - point.y * hv.z()) * w;
  return point;
}

// How dark the blurred print is at a point of its plane, 0 white to 1 black.
struct SmallPatternFitter::Darkness {
  double value;
  double by_x, by_y;  // per metre
  double by_log_blur;
  double ring;                 // of the ring alone
  std::array<double, 2> arms;  // of the arms along x and along y
};

// Where the light over the print changes: a soft straight edge between two lights.
struct SmallPatternFitter::ShadowEdge {
  Eigen::Vector2d normal{0, 0};  // unit vector in the plane, zero where there is no edge
  double offset = 0;             // of the edge along the normal, metres
  double before = 1;             // factors that make the light even on the two sides
  double behind = 1;

  // Share of the light behind the edge, 0 to 1, at so many metres behind it.
  static double ShareAt(double distance) {
    constexpr double kSoftness = 0.08;  // metres from the edge to where it ends
    return std::clamp(0.5 + distance / (2 * kSoftness), 0.0, 1.0);
  }
  double Factor(double x, double y) const {
    const double share = ShareAt(normal.x() * x + normal.y() * y - offset);
    return 1 / ((1 - share) / before + share / behind);
  }
};

// The unknowns of a fit.
struct SmallPatternFitter::State {
  RigidTransform pose;
  double blur_px = kGoodLensBlurPx;
  double white = 255;   // gray value, which the image may cut off
  double contrast = 0;  // white minus black

  ShadowEdge edge;              // taken out of the gray values before the fit
  Eigen::Vector2d slope{0, 0};  // of the light over the print, gray values per metre

  double White(const PlanePoint& point) const {
    return white + slope.x() * point.x + slope.y() * point.y;
  }
  double Gray(const PlanePoint& point, double dark) const { return White(point) - contrast * dark; }
  // A gray value without what makes it brighter than the print can be: a highlight is no sign.
  double WithoutHighlight(const PlanePoint& point, double gray) const {
    return std::min(gray, BrightestWhite(point));
  }
  bool IsHighlight(const PlanePoint& point, double gray) const {
    return gray > BrightestWhite(point);
  }
  double BrightestWhite(const PlanePoint& point) const {
    constexpr double kMargin = 0.1;  // of the contrast
    return White(point) + kMargin * contrast;
  }
};

}  // namespace kestrel
