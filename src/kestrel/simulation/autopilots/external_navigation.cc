// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/external_navigation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kKept_us = 1'000'000;
constexpr std::int64_t kArduPilotHolds_us = 7'000'000;
constexpr std::int64_t kLate_us = 200'000;  // PX4 begins with steady messages only
constexpr double kDrift_mps = 0.1;          // how fast dead reckoning drifts

}  // namespace

void ExternalNavigation::Observe(std::int64_t boot_us, double step_s, const Vector3d& place) {
  places_.push_back({boot_us, place});
  while (places_.front().boot_us < boot_us - kKept_us) places_.pop_front();
  if (used_us_ && boot_us - *used_us_ > kLate_us) error_.x() += kDrift_mps * step_s;
}

void ExternalNavigation::Handle(const mavlink::Odometry& message) {
  if (!Uses(message)) return;
  const auto place = PlaceAt(static_cast<std::int64_t>(message.time_usec));
  if (!place) return;
  const Vector3d error = EnuFromNed(Vector3d(message.x, message.y, message.z)) - *place;
  if (!error.allFinite()) return;
  const bool jumps = !has_position() || message.reset_counter != resets_;
  resets_ = message.reset_counter;
  constexpr double kShare = 0.2;  // how much of the estimate a message is
  const Vector3d change = (jumps ? 1 : kShare) * (error - error_);
  if (jumps) jump_ += change;
  error_ += change;
  used_us_ = places_.back().boot_us;
}

// Others are dropped without a word.
bool ExternalNavigation::Uses(const mavlink::Odometry& message) const {
  if (message.child_frame_id != mavlink::kFrameBodyFrd || places_.empty()) return false;
  if (firmware_ == AutopilotFirmware::kArduPilot) {
    constexpr double kExternal = 6;
    return message.frame_id == mavlink::kFrameLocalFrd && parameters_["VISO_TYPE"] > 0 &&
           parameters_["EK3_SRC1_POSXY"] == kExternal;
  }
  const auto control = static_cast<unsigned>(parameters_["EKF2_EV_CTRL"]);
  const bool is_known_frame =
      message.frame_id == mavlink::kFrameLocalFrd || message.frame_id == mavlink::kFrameLocalNed;
  return is_known_frame && (control & 1) != 0;
}

bool ExternalNavigation::has_position() const {
  const std::int64_t holds_us = firmware_ == AutopilotFirmware::kPx4
                                    ? static_cast<std::int64_t>(parameters_["EKF2_NOAID_TOUT"])
                                    : kArduPilotHolds_us;
  return used_us_ && places_.back().boot_us - *used_us_ < holds_us;
}

Vector3d ExternalNavigation::TakeJump() { return std::exchange(jump_, Vector3d::Zero()); }

std::optional<Vector3d> ExternalNavigation::PlaceAt(std::int64_t boot_us) const {
  const auto after = std::lower_bound(
      places_.begin(), places_.end(), boot_us,
      [](const Place& place, std::int64_t time_us) { return place.boot_us < time_us; });
  if (after == places_.end() || after == places_.begin()) return std::nullopt;
  return after->place;
}

}  // namespace kestrel
