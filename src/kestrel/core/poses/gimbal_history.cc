// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/poses/gimbal_history.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

// The slowest gimbals report once a second.
constexpr Duration kMaxGap = std::chrono::milliseconds(1500);
// Standard deviation of the platform's angular acceleration: it swings to 90 deg/s within a second
// or two, and stands still most of the time.
constexpr double kAcceleration_radps2 = 1;

// The rotation from one report to the next, continued to 'part' of the way.
Eigen::Quaterniond Continued(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to,
                             double part) {
  return (from * RotationBy(part * RotationVector(from.conjugate() * to))).normalized();
}

// The line through two reports departs from a motion with this acceleration by the remainder of a
// linear interpolation, which holds after the second report, too.
double Remainder(double since_first_s, double since_second_s) {
  return 0.5 * kAcceleration_radps2 * std::abs(since_first_s * since_second_s);
}

}  // namespace

const char* ToString(YawFrame frame) { return frame == YawFrame::kEarth ? "earth" : "vehicle"; }

RigidTransform WorldFromPlatform(const RigidTransform& world_from_body,
                                 const RigidTransform& body_from_pivot,
                                 const GimbalAttitude& attitude) {
  RigidTransform pose = world_from_body * body_from_pivot;
  const double heading = attitude.yaw_frame == YawFrame::kVehicle ? HeadingOf(pose.rotation) : 0;
  pose.rotation =
      (RotationBy(heading * Eigen::Vector3d::UnitZ()) * attitude.level_from_platform).normalized();
  return pose;
}

GimbalHistory::GimbalHistory(std::size_t capacity) : ring_(std::max<std::size_t>(capacity, 2)) {}

PoseStatus GimbalHistory::Add(const GimbalSample& sample) {
  constexpr double kTolerance = 0.01;
  const double error = std::abs(sample.level_from_platform.norm() - 1);
  if (!(error < kTolerance)) return PoseStatus::kInvalid;
  if (size_ > 0 && sample.time <= Sample(size_ - 1).time) return PoseStatus::kOutOfOrder;
  GimbalSample& slot = ring_[(first_ + size_) % ring_.size()];
  slot = sample;
  slot.level_from_platform.normalize();
  if (size_ < ring_.size()) {
    ++size_;
  } else {
    first_ = (first_ + 1) % ring_.size();
  }
  return PoseStatus::kOk;
}

// Index of the first sample not before 'time', by bisection; size_ when there is none.
std::size_t GimbalHistory::FirstNotBefore(Time time) const {
  std::size_t begin = 0;
  for (std::size_t end = size_; begin < end;) {
    const std::size_t middle = begin + (end - begin) / 2;
    if (Sample(middle).time < time) {
      begin = middle + 1;
    } else {
      end = middle;
    }
  }
  return begin;
}

std::optional<GimbalAttitude> GimbalHistory::At(Time time, Duration max_ahead) const {
  if (size_ == 0 || time < Sample(0).time || time > Sample(size_ - 1).time + max_ahead) {
    return std::nullopt;
  }
  const std::size_t after = std::min(FirstNotBefore(time), size_ - 1);
  const GimbalSample& to = Sample(after);
  if (to.time == time) return GimbalAttitude{to.level_from_platform, to.yaw_frame};
  if (after == 0) return std::nullopt;
  const GimbalSample& from = Sample(after - 1);
  if (to.yaw_frame != from.yaw_frame || to.time - from.time > kMaxGap) return std::nullopt;
  const double since_first_s = ToSeconds(time - from.time);
  const double part = since_first_s / ToSeconds(to.time - from.time);
  return GimbalAttitude{Continued(from.level_from_platform, to.level_from_platform, part),
                        to.yaw_frame, Remainder(since_first_s, ToSeconds(time - to.time))};
}

}  // namespace kestrel
