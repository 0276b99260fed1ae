// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/vision/pipeline/camera_poses.h"

namespace kestrel {

// Estimates from the sightings of one camera alone how late its images are stamped. With the poses
// of wrong times the target seems to move as the UAV turns; with those of the right times it moves
// smoothly.
class StampLag {
 public:
  // Takes a sighting at a time on the images' clock. 'center_in_camera': the target (m); 'sigma_m':
  // standard deviation of its place in the world, horizontal, per axis.
  void Add(Time time, const Eigen::Vector3d& center_in_camera, double sigma_m);

  // Returns how late (s; negative: early) the images are stamped, with the poses of that camera.
  // Nothing where the stamps may be right to CameraLag::kLongest_s, or where the latest seconds
  // do not determine it. Does not allocate.
  std::optional<double> Contradiction(const CameraPoses& poses) const;

 private:
  static constexpr std::size_t kCapacity = 64;

  struct Sighting {
    Time time;
    Eigen::Vector3d center_in_camera;
    double sigma_m;
  };
  // The sightings whose poses are known for all lags.
  struct Usable {
    std::array<const Sighting*, kCapacity> sightings;
    std::size_t count = 0;
  };

  Usable WithPoses(const CameraPoses& poses) const;
  double Misfit(const Usable& usable, double lag_s, const CameraPoses& poses) const;

  std::array<Sighting, kCapacity> sightings_;  // ring
  std::size_t added_ = 0;
};

}  // namespace kestrel
