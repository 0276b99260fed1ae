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

// How the body moves.
struct BodyMotion {
  Eigen::Vector3d velocity_in_world{0, 0, 0};  // m/s
  Eigen::Vector3d rate_in_body{0, 0, 0};       // angular velocity, rad/s
};

// Where the body (FLU) was in the world (ENU) at an instant of the navigation's clock.
struct PoseSample {
  Time time;
  RigidTransform world_from_body;
  std::optional<BodyMotion> motion = std::nullopt;  // where the navigation tells it
};

// How the motion that a sample tells may change before the next one: what a pose ahead of the
// samples costs. Standard deviations per axis.
struct UnmodelledMotion {
  double acceleration_mps2 = 3;            // of a multicopter that holds its place in gusts
  double angular_acceleration_radps2 = 5;  // more for small, agile ones
  double velocity_sigma_mps = 0.1;         // of the velocity that is told
  double rate_sigma_radps = 0.02;          // of the angular velocity that is told

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("acceleration_mps2", self.acceleration_mps2, "m/s^2", "that nothing tells, per axis");
    visitor("angular_acceleration_radps2", self.angular_acceleration_radps2, "rad/s^2",
            "that nothing tells, per axis");
    visitor("velocity_sigma_mps", self.velocity_sigma_mps, "m/s",
            "of the velocity that the navigation tells, per axis");
    visitor("rate_sigma_radps", self.rate_sigma_radps, "rad/s",
            "of the angular velocity that the navigation tells, per axis");
  }
  std::vector<std::string> Validate() const;
};

// Standard deviations per axis by which a pose is less sure than a sample.
struct PoseUncertainty {
  double position_m = 0;
  double attitude_rad = 0;
};

struct PredictedPose {
  RigidTransform world_from_body;
  PoseUncertainty uncertainty;  // 0 between the samples
  BodyMotion motion;            // at the newest sample; 0 where it is not known
};

enum class PoseStatus {
  kOk,
  kOutOfOrder,  // not later than the newest sample
  kInvalid,     // not finite, or the rotation is no unit quaternion (to 1 %)
};

// Whether there is a pose for an instant, or why not.
enum class PoseLookup {
  kFound,
  kEmpty,      // there are no samples at all
  kTooOld,     // before the oldest sample
  kTooNew,     // after the newest sample
  kGap,        // the samples around it are too far apart
  kPredicted,  // after the newest sample, and predicted from it
};
// "found", "no poses", "too old", "too new", "gap", "predicted"
const char* ToString(PoseLookup lookup);

// The last poses of the UAV, in order of time, and where it was between them. Bounded: the oldest
// sample makes room for the newest. Allocates at construction only; never throws afterwards.
class PoseHistory {
 public:
  // Keeps up to 'capacity' samples (at least 1). Between two samples that are further apart than
  // 'max_gap' there is no pose: the navigation was away, and a guess would pass for a measurement.
  PoseHistory(std::size_t capacity, Duration max_gap);

  // A sample that is refused leaves the history as it was.
  PoseStatus Add(const PoseSample& sample);

  // Whether Lookup has an answer, or why not.
  PoseLookup Check(Time time) const;
  bool Has(Time time) const { return Check(time) == PoseLookup::kFound; }

  // 'world_from_body' at 'time': the sample itself, or between its neighbours the translation by
  // straight line and the rotation by the shortest arc (slerp). Nothing outside of the samples.
  std::optional<RigidTransform> Lookup(Time time) const;

  // The same with less noise: the value at 'time' of the lines, of position and of rotation vector,
  // that fit the samples up to 'half_window' before and after it best. In flight those after it are
  // still to come, and the lines end there. Motion that bends within the window is flattened. As
  // Lookup where fewer than four samples are around.
  std::optional<RigidTransform> Smooth(Time time, Duration half_window) const;

  // As Lookup, and up to 'max_ahead' after the newest sample the pose that its motion leads to,
  // with what 'unmodelled' may have changed meanwhile. Without a motion in the newest sample it is
  // the mean one of the samples of the last 50 ms. Nothing when no motion is known.
  std::optional<PredictedPose> Predict(Time time, Duration max_ahead,
                                       const UnmodelledMotion& unmodelled) const;

  std::size_t size() const { return size_; }
  std::size_t capacity() const { return ring_.size(); }

 private:
  const PoseSample& At(std::size_t i) const { return ring_[(first_ + i) % ring_.size()]; }
  std::size_t FirstNotBefore(Time time) const;

  // How the body moves at the newest sample, as it was some time ago on the average.
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
