// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/external_pose.h"

#include <cmath>
#include <limits>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"

namespace kestrel {
namespace {

// Places of the diagonal in the upper triangle of a 6 x 6 matrix, row by row.
constexpr std::array<std::size_t, 3> kPlaces = {0, 6, 11};
constexpr std::array<std::size_t, 3> kAngles = {15, 18, 20};

// ArduPilot takes the cube root of the sum of the squared variances for the standard deviation:
// three equal variances that it reads as 'sigma'.
double VarianceForArduPilot(double sigma) { return std::sqrt(std::pow(sigma, 3) / 3); }

}  // namespace

mavlink::Odometry OdometryOf(const ExternalPose& pose, AutopilotKind kind, std::uint64_t stamp_us) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  constexpr std::int8_t kFullQuality = 100;
  const Eigen::Vector3f place = NedFromEnu(pose.frame_from_body.translation).cast<float>();
  const Eigen::Quaternionf q = NedFrdFromEnuFlu(pose.frame_from_body.rotation).cast<float>();
  mavlink::Odometry message;
  message.time_usec = stamp_us;
  message.frame_id = mavlink::kFrameLocalFrd;
  message.child_frame_id = mavlink::kFrameBodyFrd;
  message.x = place.x();
  message.y = place.y();
  message.z = place.z();
  message.q = {q.w(), q.x(), q.y(), q.z()};
  message.vx = message.vy = message.vz = kUnknown;
  message.rollspeed = message.pitchspeed = message.yawspeed = kUnknown;
  message.pose_covariance.fill(0);
  Eigen::Vector3d places = NedFromEnu(pose.covariance.diagonal()).cwiseAbs();
  Eigen::Vector3d angles(pose.tilt_sigma, pose.tilt_sigma, pose.heading_sigma);
  angles = angles.cwiseAbs2();
  if (kind == AutopilotKind::kArduPilot) {
    places.setConstant(VarianceForArduPilot(std::sqrt(places.mean())));
    angles.setConstant(VarianceForArduPilot(pose.heading_sigma));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    message.pose_covariance[kPlaces[i]] = static_cast<float>(places[i]);
    message.pose_covariance[kAngles[i]] = static_cast<float>(angles[i]);
  }
  message.velocity_covariance.fill(kUnknown);
  message.reset_counter = pose.resets;
  message.estimator_type = mavlink::kEstimatorTypeVision;
  message.quality = kFullQuality;
  return message;
}

}  // namespace kestrel
