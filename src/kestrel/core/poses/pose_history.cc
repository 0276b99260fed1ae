// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/poses/pose_history.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

bool IsValid(const PoseSample& sample) {
  const RigidTransform& pose = sample.world_from_body;
  const auto& motion = sample.motion;
  return pose.translation.allFinite() && std::abs(pose.rotation.norm() - 1) < 0.01 &&
         (!motion || (motion->velocity_in_world.allFinite() && motion->rate_in_body.allFinite()));
}

RigidTransform Interpolate(const RigidTransform& from, const RigidTransform& to, double part) {
  return {from.rotation.slerp(part, to.rotation),
          from.translation + part * (to.translation - from.translation)};
}

// Standard deviation of the change within 'ahead' due to the errors of a rate and an unknown
// acceleration. The rate is 'age' old.
double Growth(double rate_sigma, double acceleration, double ahead, double age) {
  return std::hypot(rate_sigma * ahead, acceleration * ahead * (0.5 * ahead + age));
}

// An autopilot turns a multicopter no faster (PX4's MC_ROLLRATE_MAX is 220 deg/s); the shock of a
// touch-down does, for an instant.
constexpr double kFastestTurn_radps = 4;

Eigen::Vector3d WithoutShock(const Eigen::Vector3d& rate) {
  const double turn = rate.norm();
  return turn > kFastestTurn_radps ? Eigen::Vector3d(kFastestTurn_radps / turn * rate) : rate;
}

}  // namespace

const char* ToString(PoseLookup lookup) {
  switch (lookup) {
    case PoseLookup::kFound:
      return "found";
    case PoseLookup::kEmpty:
      return "no poses";
    case PoseLookup::kTooOld:
      return "too old";
    case PoseLookup::kTooNew:
      return "too new";
    case PoseLookup::kGap:
      return "gap";
    case PoseLookup::kPredicted:
      return "predicted";
    case PoseLookup::kNoGimbal:
      return "no report of the gimbal";
  }
  return "";
}

PoseHistory::PoseHistory(std::size_t capacity, Duration max_gap)
    : ring_(std::max<std::size_t>(capacity, 1)), max_gap_(max_gap) {}

PoseStatus PoseHistory::Add(const PoseSample& sample) {
  if (!IsValid(sample)) return PoseStatus::kInvalid;
  if (size_ > 0 && sample.time <= At(size_ - 1).time) return PoseStatus::kOutOfOrder;
  PoseSample& slot = ring_[(first_ + size_) % ring_.size()];
  slot = sample;
  slot.world_from_body.rotation.normalize();
  if (size_ < ring_.size()) {
    ++size_;
  } else {
    first_ = (first_ + 1) % ring_.size();
  }
  return PoseStatus::kOk;
}

// Index of the first sample not before 'time', by bisection; size_ when there is none.
std::size_t PoseHistory::FirstNotBefore(Time time) const {
  std::size_t begin = 0;
  for (std::size_t end = size_; begin < end;) {
    const std::size_t middle = begin + (end - begin) / 2;
    if (At(middle).time < time) {
      begin = middle + 1;
    } else {
      end = middle;
    }
  }
  return begin;
}

PoseLookup PoseHistory::Check(Time time) const {
  if (size_ == 0) return PoseLookup::kEmpty;
  const std::size_t after = FirstNotBefore(time);
  if (after == size_) return PoseLookup::kTooNew;
  if (At(after).time == time) return PoseLookup::kFound;
  if (after == 0) return PoseLookup::kTooOld;
  return At(after).time - At(after - 1).time > max_gap_ ? PoseLookup::kGap : PoseLookup::kFound;
}

std::optional<RigidTransform> PoseHistory::Lookup(Time time) const {
  if (!Has(time)) return std::nullopt;
  const std::size_t index = FirstNotBefore(time);
  const PoseSample& after = At(index);
  if (after.time == time) return after.world_from_body;
  const PoseSample& before = At(index - 1);
  const double part = ToSeconds(time - before.time) / ToSeconds(after.time - before.time);
  return Interpolate(before.world_from_body, after.world_from_body, part);
}

std::optional<RigidTransform> PoseHistory::Smooth(Time time, Duration half_window) const {
  constexpr double kMinSamples = 4;
  std::optional<RigidTransform> pose = Lookup(time);
  if (!pose) return std::nullopt;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  const Eigen::Quaterniond back = pose->rotation.conjugate();
  double count = 0;
  double sum_t = 0;
  double sum_tt = 0;
  Vector6 sum = Vector6::Zero();  // sum of the samples' offsets from 'pose'
  Vector6 sum_times_t = Vector6::Zero();
  for (std::size_t i = FirstNotBefore(time - half_window);
       i < size_ && At(i).time <= time + half_window; ++i) {
    const RigidTransform& sample = At(i).world_from_body;
    const double t = ToSeconds(At(i).time - time);
    Vector6 offset;
    offset << sample.translation - pose->translation, RotationVector(sample.rotation * back);
    ++count;
    sum_t += t;
    sum_tt += t * t;
    sum += offset;
    sum_times_t += t * offset;
  }
  if (count < kMinSamples) return pose;
  const Vector6 offset = (sum_tt * sum - sum_t * sum_times_t) / (count * sum_tt - sum_t * sum_t);
  return Moved(*pose, offset.head<3>(), offset.tail<3>());
}

std::optional<PoseHistory::NewestMotion> PoseHistory::MotionOfNewest() const {
  constexpr Duration kBaseline = std::chrono::milliseconds(50);
  const PoseSample& newest = At(size_ - 1);
  if (newest.motion) return NewestMotion{*newest.motion, Duration::zero()};
  if (size_ < 2) return std::nullopt;
  const std::size_t index = std::min(FirstNotBefore(newest.time - kBaseline), size_ - 2);
  if (newest.time - At(index).time > max_gap_) return std::nullopt;
  const RigidTransform& from = At(index).world_from_body;
  const RigidTransform& to = newest.world_from_body;
  const Duration span = newest.time - At(index).time;
  const double rate = 1 / ToSeconds(span);
  return NewestMotion{{rate * (to.translation - from.translation),
                       rate * RotationVector(from.rotation.conjugate() * to.rotation)},
                      span / 2};
}

std::optional<PredictedPose> PoseHistory::Predict(Time time, Duration max_ahead,
                                                  const UnmodelledMotion& unmodelled) const {
  if (const auto pose = Lookup(time)) {
    const auto newest = MotionOfNewest();
    return PredictedPose{*pose, {}, newest ? newest->motion : BodyMotion{}};
  }
  if (Check(time) != PoseLookup::kTooNew) return std::nullopt;
  const PoseSample& newest = At(size_ - 1);
  if (time - newest.time > max_ahead) return std::nullopt;
  const auto newest_motion = MotionOfNewest();
  if (!newest_motion) return std::nullopt;
  const auto& [motion, motion_age] = *newest_motion;
  const double ahead = ToSeconds(time - newest.time);
  const double age = ToSeconds(motion_age);
  const RigidTransform& pose = newest.world_from_body;
  return PredictedPose{
      {(pose.rotation * RotationBy(ahead * WithoutShock(motion.rate_in_body))).normalized(),
       pose.translation + ahead * motion.velocity_in_world},
      {Growth(unmodelled.velocity_sigma_mps, unmodelled.acceleration_mps2, ahead, age),
       Growth(unmodelled.rate_sigma_radps, unmodelled.angular_acceleration_radps2, ahead, age)},
      motion,
      ahead};
}

Eigen::Vector3d PoseHistory::Acceleration() const {
  constexpr Duration kBaseline = std::chrono::milliseconds(100);
  if (size_ < 2) return Eigen::Vector3d::Zero();
  const PoseSample& newest = At(size_ - 1);
  const PoseSample& earlier = At(std::min(FirstNotBefore(newest.time - kBaseline), size_ - 2));
  const Duration span = newest.time - earlier.time;
  if (!newest.motion || !earlier.motion || span > max_gap_) return Eigen::Vector3d::Zero();
  return (newest.motion->velocity_in_world - earlier.motion->velocity_in_world) / ToSeconds(span);
}

}  // namespace kestrel
