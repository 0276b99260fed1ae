// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "kestrel/base/time.h"
#include "kestrel/geometry/rigid_transform.h"

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

enum class PoseStatus {
  kOk,
  kOutOfOrder,  // not later than the newest sample
  kInvalid,     // not finite, or the rotation is no unit quaternion (to 1 %)
};

// Whether there is a pose for an instant, or why not.
enum class PoseLookup {
  kFound,
  kEmpty,   // there are no samples at all
  kTooOld,  // before the oldest sample
  kTooNew,  // after the newest sample
  kGap,     // the samples around it are too far apart
};
const char* ToString(PoseLookup lookup);  // "found", "no poses", "too old", "too new", "gap"

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

  std::size_t size() const { return size_; }
  std::size_t capacity() const { return ring_.size(); }

 private:
  const PoseSample& At(std::size_t i) const { return ring_[(first_ + i) % ring_.size()]; }
  std::size_t FirstNotBefore(Time time) const;

  std::vector<PoseSample> ring_;
  Duration max_gap_;
  std::size_t first_ = 0;  // index of the oldest sample in the ring
  std::size_t size_ = 0;
};

}  // namespace kestrel
