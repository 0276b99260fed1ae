// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/gimbal_angles.h"

namespace kestrel {

// The view of a camera on a gimbal.
struct GimbalView {
  double axis_pitch = 0;            // of the optical axis, down from the platform's x axis, rad
  double half_angle = Radians(30);  // of the image along its shorter side, rad
  double pad_size_m = 1;            // diameter of the target
  double sight_range_m = 0;         // from which the camera sees it at most; 0: down only
};

// All inputs at an instant, predicted to the time at which the gimbal has followed.
struct PointingInput {
  Time now;
  RigidTransform world_from_pivot;        // place of the gimbal; x: the nose of the UAV
  std::optional<Eigen::Vector3d> target;  // in the world; nothing: searches
};

enum class PointingStep {
  kSearch,
  kTarget,
  kDown,  // close above the target
};

// Decides where a gimbal points: at the target; straight down close above it, where its direction
// changes faster than a gimbal turns; and, while there is none, down and then around on circles
// that lie as far apart as the camera sees, out to the range of sight on the ground. The gimbal
// closes its own loop: what is returned does not depend on its reports, however late and rare they
// are. No clock, no link.
class GimbalPointing {
 public:
  explicit GimbalPointing(const GimbalView& view) : view_(view) {}

  void set_range(const GimbalRange& range) { range_ = range; }

  // Returns the platform's attitude with the yaw in the world. Call it in order of time, ten times
  // a second or more.
  GimbalAngles Update(const PointingInput& input);

  PointingStep step() const { return step_; }

 private:
  GimbalAngles PointAt(const Eigen::Vector3d& ray, double heading);
  GimbalAngles Search(double height_m, double heading, double seconds);
  void BeginCircle(int circle);
  bool IsClose(const Eigen::Vector3d& ray) const;
  bool StaysDown(double height_m) const;
  GimbalAngles WithinRange(double yaw, double axis_pitch, double heading) const;

  GimbalView view_;
  GimbalRange range_;
  PointingStep step_ = PointingStep::kSearch;
  std::optional<Time> last_;
  std::optional<double> held_yaw_;  // of the camera, near the vertical
  bool is_steep_ = false;           // the target is near the vertical
  double ground_m_ = 0;             // height of the target when it was last known
  int circle_ = 0;                  // of the search; 0: looks down
  double searched_ = 0;             // on it: s while it looks down, then rad
};

}  // namespace kestrel
