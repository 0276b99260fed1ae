// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/track_snapshot.h"

#include <cmath>

namespace kestrel {

TrackSnapshot::Sight SightOf(const TargetDetection& detection,
                             const RigidTransform& camera_from_body, Time time) {
  const RigidTransform& camera_from_target = detection.camera_from_target;
  const Eigen::Matrix3d body_from_camera = camera_from_body.rotation.toRotationMatrix().transpose();
  const Eigen::Vector3d normal = camera_from_target.rotation * Eigen::Vector3d::UnitZ();
  TrackSnapshot::Sight sight;
  sight.time = time;
  sight.target_from_body = camera_from_target.Inverse() * camera_from_body;
  sight.covariance =
      body_from_camera * detection.covariance.topLeftCorner<3, 3>() * body_from_camera.transpose();
  sight.heading_sigma =
      std::sqrt(normal.dot(detection.covariance.bottomRightCorner<3, 3>() * normal));
  sight.heading_symmetry = detection.heading_symmetry;
  return sight;
}

}  // namespace kestrel
