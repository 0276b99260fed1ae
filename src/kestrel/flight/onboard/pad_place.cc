// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/pad_place.h"

#include <cmath>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kTiltSigma = Radians(1);  // for an autopilot that knows no velocity

// Covariance of a vector turned by a rotation that is uncertain about each axis.
Matrix3d OfTurn(const Vector3d& vector, const Vector3d& sigma) {
  Matrix3d cross;
  cross << 0, -vector.z(), vector.y(), vector.z(), 0, -vector.x(), -vector.y(), vector.x(), 0;
  return cross * sigma.cwiseAbs2().asDiagonal() * cross.transpose();
}

}  // namespace

ExternalPose PadPlace::Update(const TrackSnapshot::Sight& sight,
                              const Eigen::Quaterniond& world_from_body, HeadingSource source) {
  const double own = HeadingOf(world_from_body);
  const bool is_by_pad = source == HeadingSource::kPad && sight.heading_symmetry > 0;
  const double heading = sight.heading_symmetry > 0 ? HeadingByPad(sight, own) : own;
  const double turn = is_by_pad ? heading - own : 0;
  ExternalPose pose;
  pose.time = sight.time;
  pose.frame_from_body.rotation =
      Eigen::Quaterniond(Eigen::AngleAxisd(turn, Vector3d::UnitZ())) * world_from_body;
  const Matrix3d rotation = pose.frame_from_body.rotation.toRotationMatrix();
  const Vector3d center = rotation * sight.target_from_body.Inverse().translation;
  pose.frame_from_body.translation = -center;
  pose.tilt_sigma = kTiltSigma;
  pose.heading_sigma = is_by_pad ? sight.heading_sigma : kTiltSigma;
  // An error of the autopilot's own heading turns its whole world, the place with it.
  const double heading_error = is_by_pad ? sight.heading_sigma : 0;
  pose.covariance = rotation * sight.covariance * rotation.transpose() +
                    OfTurn(center, {kTiltSigma, kTiltSigma, heading_error});
  CountJump(pose);
  pose.resets = static_cast<std::uint8_t>(resets_);
  last_ = pose;
  return pose;
}

// Returns the heading of the UAV in the frame. Of the headings under which the pad looks the same
// the one counts that the autopilot's turns lead to.
double PadPlace::HeadingByPad(const TrackSnapshot::Sight& sight, double own) {
  const double on_pad = HeadingOf(sight.target_from_body.rotation);
  const double expected = own - heading_drift_;
  // Tags in a ring determine more than the ring alone did from afar; the ring may be a quarter off.
  if (!heading_of_pad_ || sight.heading_symmetry < symmetry_) {
    heading_of_pad_ = expected - on_pad;
    symmetry_ = sight.heading_symmetry;
  }
  const double period = 2 * kPi / sight.heading_symmetry;
  const double heading = expected + std::remainder(on_pad + *heading_of_pad_ - expected, period);
  heading_drift_ = own - heading;
  return heading;
}

void PadPlace::CountJump(const ExternalPose& pose) {
  constexpr double kFastest_mps = 10;
  constexpr double kLeast_m = 0.3;
  constexpr double kSure = 5;  // standard deviations
  if (!last_) return;
  const double seconds = ToSeconds(pose.time - last_->time);
  const double moved_m =
      (pose.frame_from_body.translation - last_->frame_from_body.translation).norm();
  const double sigma_m = std::sqrt((pose.covariance + last_->covariance).trace());
  if (moved_m > kLeast_m + kFastest_mps * seconds + kSure * sigma_m) ++resets_;
}

}  // namespace kestrel
