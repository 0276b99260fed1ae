// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/camera_sighting.h"

#include <cmath>

namespace kestrel {

CameraSighting SightingBy(const OffsetFromTrack& by, const Eigen::Quaterniond& body_from_world,
                          Time time) {
  const double square = by.sight.squaredNorm();
  const auto turn_by = [&](const Eigen::Vector3d& shift_m) -> Eigen::Vector3d {
    return body_from_world * by.sight.cross(shift_m) / square;
  };
  CameraSighting sighting;
  sighting.time = time;
  sighting.offset_m = by.offset_m.norm();
  sighting.sigma_m = std::hypot(by.track_sigma_m, by.lag_m.norm());
  sighting.distance_m = std::sqrt(square);
  const double most_m = CameraSighting::kSigmas * sighting.sigma_m +
                        CameraSighting::kTolerated_rad * sighting.distance_m;
  sighting.place = sighting.offset_m > most_m ? SightingPlace::kOutside : SightingPlace::kInside;
  sighting.turn = turn_by(by.offset_m);
  sighting.turn_by_lag = turn_by(CameraSighting::kSigmas * by.lag_m);
  const double along = by.sight.dot(by.covariance * by.sight) / square;
  sighting.turn_variance = (by.covariance.trace() - along) / (2 * square);
  return sighting;
}

}  // namespace kestrel
