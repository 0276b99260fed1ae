// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// Motion of the body.
struct BodyMotion {
  Eigen::Vector3d velocity_in_world{0, 0, 0};  // m/s
  Eigen::Vector3d rate_in_body{0, 0, 0};       // angular velocity, rad/s
};

// Pose of the body (FLU) in the world (ENU) at an instant of the navigation's clock.
struct PoseSample {
  Time time;
  RigidTransform world_from_body;
  std::optional<BodyMotion> motion = std::nullopt;  // where the navigation reports it
  double time_sigma_s = 0;  // standard deviation of 'time': over a link clocks agree within this
};

// Changes of the motion that no sample reports, which make a prediction beyond the samples
// uncertain. Standard deviations per axis.
struct UnmodelledMotion {
  double acceleration_mps2 = 3;            // that of a multicopter that hovers in gusts
  double angular_acceleration_radps2 = 5;  // higher for small, agile ones
  double velocity_sigma_mps = 0.1;         // error of the reported velocity
  double rate_sigma_radps = 0.02;          // error of the reported angular velocity
};

// Standard deviations per axis that a pose has in addition to those of a sample.
struct PoseUncertainty {
  double position_m = 0;
  double attitude_rad = 0;
};

struct PredictedPose {
  RigidTransform world_from_body;
  PoseUncertainty uncertainty;  // 0 between the samples
  BodyMotion motion;            // at the newest sample; 0 where it is unknown
  double ahead_s = 0;           // time since the newest sample; 0 between the samples
};

enum class PoseStatus {
  kOk,
  kOutOfOrder,  // not later than the newest sample
  kInvalid,     // not finite, or the rotation is not a unit quaternion (to 1 %)
};

// Result of looking up the pose of an instant.
enum class PoseLookup {
  kFound,
  kEmpty,      // there are no samples at all
  kTooOld,     // before the oldest sample
  kTooNew,     // after the newest sample
  kGap,        // the samples around it are too far apart
  kPredicted,  // after the newest sample, and predicted from it
  kNoGimbal,   // there is one, but the gimbal of the camera has not reported its attitude
};
// "found", "no poses", "too old", "too new", "gap", "predicted", "no report of the gimbal"
const char* ToString(PoseLookup lookup);

// The latest poses of the UAV, in order of time, with interpolation. Bounded: the newest sample
// replaces the oldest. Allocates at construction only and never throws afterwards.
class PoseHistory {
 public:
  // Keeps up to 'capacity' samples (at least 1). Between two samples farther apart than 'max_gap'
  // there is no pose: the navigation was interrupted, and a guess would be taken for a measurement.
  PoseHistory(std::size_t capacity, Duration max_gap);

  // A rejected sample leaves the history unchanged.
  PoseStatus Add(const PoseSample& sample);

  // Returns whether Lookup has a result, or why not.
  PoseLookup Check(Time time) const;
  bool Has(Time time) const { return Check(time) == PoseLookup::kFound; }

  // Returns 'world_from_body' at 'time': the sample itself, or an interpolation between its
  // neighbours, linear for the translation and along the shortest arc (slerp) for the rotation.
  // Nothing outside of the samples.
  std::optional<RigidTransform> Lookup(Time time) const;

  // The same with less noise: fits lines of position and of rotation vector to the samples up to
  // 'half_window' before and after 'time', and returns their value at 'time'. In flight the samples
  // after it have not arrived, and the lines end there. Curved motion within the window is
  // flattened. Same as Lookup where fewer than four samples are near.
  std::optional<RigidTransform> Smooth(Time time, Duration half_window) const;

  // Same as Lookup, and up to 'max_ahead' after the newest sample it extrapolates the motion of
  // that sample, with the uncertainty due to 'unmodelled', but no turn above 4 rad/s. When the
  // newest sample has no motion, it uses the mean motion over the last 50 ms. Nothing when no
  // motion is known.
  std::optional<PredictedPose> Predict(Time time, Duration max_ahead,
                                       const UnmodelledMotion& unmodelled) const;

  // Returns the acceleration in the world (m/s^2) at the newest sample: the change of the reported
  // velocity over the last 100 ms. 0 when no velocities are reported.
  Eigen::Vector3d Acceleration() const;

  std::size_t size() const { return size_; }
  std::size_t capacity() const { return ring_.size(); }

 private:
  const PoseSample& At(std::size_t i) const { return ring_[(first_ + i) % ring_.size()]; }
  std::size_t FirstNotBefore(Time time) const;

  // Mean motion at the newest sample, and the age of that mean.
  struct NewestMotion {
    BodyMotion motion;
    Duration age;
  };
  std::optional<NewestMotion> MotionOfNewest() const;

  std::vector<PoseSample> ring_;
  Duration max_gap_;
  std::size_t first_ = 0;  // index of the oldest sample in the ring
  std::size_t size_ = 0;
};

}  // namespace kestrel
