// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "kestrel/core/geometry/cone.h"

namespace kestrel {

// Least descent of a ray, the sine of its angle to the ground, at which it has a place there: below
// that (3 degrees) a small error of the attitude moves the place without bound.
inline constexpr double kMinDescent = 0.05;

// The ground in the camera frame, as far as attitude and height are known (paper, section 3.5.3:
// "objects that are not close to the ground are discarded").
struct GroundPlane {
  std::optional<Eigen::Vector3d> up_in_camera;
  std::optional<double> camera_height_m;
  double height_sigma_m = 0;  // standard deviation of the height, with the ground's unevenness
  double up_sigma_rad = 0;

  bool is_known() const { return up_in_camera && camera_height_m; }

  // Returns the distance nearest to 'distance' at which a point 'min_height' to 'max_height' (m)
  // above the ground lies on the line of sight 'ray' (unit vector). Nothing when the ground is not
  // known or the ray does not meet it.
  std::optional<double> DistanceNear(const Eigen::Vector3d& ray, double distance, double min_height,
                                     double max_height) const;

  // Returns the standard deviation of such a distance, m.
  double DistanceSigma(const Eigen::Vector3d& ray, double distance) const;
};

// Coordinates on the horizontal plane at unit distance below the camera. The origin is directly
// below the camera. Seen from above, x turns to y as in an image.
class PlaneBelow {
 public:
  explicit PlaneBelow(const Eigen::Vector3d& up);

  // Intersection of a ray with the plane. A ray that descends by less than 3 degrees is treated as
  // if it descended by 3 degrees.
  Eigen::Vector2d PointOf(const Eigen::Vector3d& ray) const;
  Eigen::Vector3d RayTo(const Eigen::Vector2d& point) const;  // not a unit vector

 private:
  Eigen::Vector3d up_;
  Eigen::Vector3d x_axis_;
  Eigen::Vector3d y_axis_;
};

// True when 'cone' may be the image of a horizontal disc at 'distance' along 'ray': both opening
// angles agree within the tolerance (a share) plus 'slack' (rad).
bool LooksLikeDisc(const Cone& cone, const Eigen::Vector3d& ray, double distance,
                   const Eigen::Vector3d& up, double radius, double tolerance, double slack);

// A rectangle on a plane at unit distance from the camera: its centre, and the lengths of its sides
// 0-1 and 1-2 (means of both opposite sides).
struct PlaneRectangle {
  Eigen::Vector3d center;
  Eigen::Vector2d sides;
  double skew;  // difference of the diagonals divided by their mean
};

// Intersects the rays through four corners, in order around the rectangle, with the plane at unit
// distance below the camera that has the unit normal 'up'. Returns nothing when a ray does not meet
// it.
std::optional<PlaneRectangle> RectangleOnPlane(const std::array<Eigen::Vector3d, 4>& rays,
                                               const Eigen::Vector3d& up);

}  // namespace kestrel
