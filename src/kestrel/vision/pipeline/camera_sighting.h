// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "kestrel/core/base/time.h"

namespace kestrel {

// A sighting's place by the track.
enum class SightingPlace {
  kStart,    // there was no track; it begins here
  kInside,   // where the track is, as far as mounts and clocks can be wrong
  kOutside,  // elsewhere
};

// Place of the target in one frame of a camera, compared with the track of all cameras.
struct CameraSighting {
  // Tolerated error of a mount, and tolerated noise of a sighting in standard deviations.
  static constexpr double kTolerated_rad = 0.035, kSigmas = 3;

  Time time{};
  SightingPlace place = SightingPlace::kStart;
  double offset_m = 0;    // from the track
  double sigma_m = 0;     // standard deviation of the offset of a camera that is right
  double distance_m = 0;  // from the camera
  // Rotation of the camera that explains the offset, across the line of sight, in the body's axes
  // (rad), with its variance per axis (rad^2); and its part by the largest error of the lag between
  // the cameras' clocks.
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  double turn_variance = 0;
  Eigen::Vector3d turn_by_lag = Eigen::Vector3d::Zero();
};

// A sighting beside a track, in world axes (m).
struct OffsetFromTrack {
  Eigen::Vector3d sight;       // from the camera to the target
  Eigen::Matrix3d covariance;  // its covariance, m^2
  Eigen::Vector3d offset_m;    // from the track to the target
  double track_sigma_m;        // standard deviation of the track per axis
  Eigen::Vector3d lag_m;       // offset by one standard deviation of the lag between the cameras
};
CameraSighting SightingBy(const OffsetFromTrack& by, const Eigen::Quaterniond& body_from_world,
                          Time time);

}  // namespace kestrel
