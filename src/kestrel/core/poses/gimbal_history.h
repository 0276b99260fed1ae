// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/pose_history.h"

namespace kestrel {

// The level frame in which a gimbal reports its attitude: x to the east, or along the heading of
// the body. z is up in both.
enum class YawFrame { kEarth, kVehicle };
// "earth", "vehicle"
const char* ToString(YawFrame frame);

// The attitude of a gimbal's platform (x forward, y left, z up) at an instant of the gimbal's
// clock. Roll and pitch are against the horizon, whatever the body does.
struct GimbalSample {
  Time time;
  Eigen::Quaterniond level_from_platform;
  YawFrame yaw_frame = YawFrame::kEarth;
};

// An attitude of the platform between or after its reports.
struct GimbalAttitude {
  Eigen::Quaterniond level_from_platform;
  YawFrame yaw_frame = YawFrame::kEarth;
  double sigma_rad = 0;  // per axis, of a motion that the reports do not show; 0 at a report
};

// Returns the pose of the platform in the world: its attitude is that of the gimbal, which knows
// the horizon itself; the heading of the body matters where the yaw is against that.
RigidTransform WorldFromPlatform(const RigidTransform& world_from_body,
                                 const RigidTransform& body_from_pivot,
                                 const GimbalAttitude& attitude);

// The latest reports of a gimbal, in order of time. Bounded: the newest replaces the oldest.
// Allocates at construction only and never throws afterwards.
class GimbalHistory {
 public:
  // Keeps up to 'capacity' samples, at least 2.
  explicit GimbalHistory(std::size_t capacity);

  // A rejected sample leaves the history unchanged.
  PoseStatus Add(const GimbalSample& sample);

  // Returns the attitude at 'time': between two reports by slerp, and up to 'max_ahead' after the
  // newest one by its motion since the one before. Nothing before the oldest report, and where the
  // reports are more than 1.5 s apart or differ in their yaw frame.
  std::optional<GimbalAttitude> At(Time time, Duration max_ahead) const;

 private:
  std::size_t FirstNotBefore(Time time) const;
  const GimbalSample& Sample(std::size_t i) const { return ring_[(first_ + i) % ring_.size()]; }

  std::vector<GimbalSample> ring_;
  std::size_t first_ = 0;  // index of the oldest sample in the ring
  std::size_t size_ = 0;
};

}  // namespace kestrel
