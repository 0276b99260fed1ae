// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/comms/mavlink/clock_exchange.h"
#include "kestrel/comms/mavlink/global_position.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"

namespace kestrel {

// Outcome of a message that carries a pose, or a part of one.
enum class PoseFate {
  kUsed,
  kNone,             // not needed: a repetition, or messages of another kind are better
  kNotFinite,        // an attitude or position is not finite
  kBackwards,        // it is older than the one before
  kRestarted,        // several in a row are: the autopilot's clock has restarted
  kWithoutClock,     // the autopilot's clock is not known yet
  kWithoutPosition,  // there is no recent position
};

// Makes poses from the messages of an autopilot: one for each attitude, with the position of that
// instant from the newest position and velocity. Body (FLU) in the world (ENU, origin of the
// autopilot's local frame), on the local clock.
class AutopilotPoses {
 public:
  // 'position_age_s': an older position is not used for a pose.
  explicit AutopilotPoses(double position_age_s) : position_age_s_(position_age_s) {}

  // Sets 'pose' when the result is kUsed, and without place and velocity when it is
  // kWithoutPosition. The clock learns from the stamps.
  PoseFate Handle(const mavlink::AttitudeQuaternion& message, Time received, ClockExchange* clock,
                  PoseSample* pose);
  PoseFate Handle(const mavlink::Attitude& message, Time received, ClockExchange* clock,
                  PoseSample* pose);
  PoseFate Handle(const mavlink::LocalPositionNed& message);

  // The autopilot has restarted.
  void Reset() { *this = AutopilotPoses(position_age_s_); }

  // Returns by how much the last kBackwards message was older than the one before, s.
  double back_s() const { return back_s_; }

 private:
  struct Position {
    std::uint32_t boot_ms;
    Eigen::Vector3d in_world;
    Eigen::Vector3d velocity_in_world;
  };
  struct AttitudeSample {
    std::uint32_t boot_ms;
    Eigen::Quaterniond ned_from_frd;
    Eigen::Vector3d rate_in_frd;
  };
  // Time stamps of one kind of message: they increase unless the autopilot restarts.
  struct StampOrder {
    std::optional<std::uint32_t> newest_ms;
    int backwards = 0;  // in a row
  };

  PoseFate CheckOrder(std::uint32_t boot_ms, StampOrder* order);
  PoseFate MakePose(const AttitudeSample& sample, Time received, ClockExchange* clock,
                    PoseSample* pose) const;

  double position_age_s_;
  std::optional<Position> position_;
  StampOrder attitude_order_;
  StampOrder euler_order_;
  StampOrder position_order_;
  bool has_quaternions_ = false;
  double back_s_ = 0;
};

// Returns the true pose, which simulated vehicles report, in the world with its origin at 'origin'.
// Sets 'pose' when the result is kUsed.
PoseFate TruePoseOf(const mavlink::SimState& message, AutopilotKind kind,
                    const GlobalPosition& origin, const TimeSync& clock, Time received,
                    PoseSample* pose);
PoseFate TruePoseOf(const mavlink::HilStateQuaternion& message, AutopilotKind kind,
                    const GlobalPosition& origin, const TimeSync& clock, PoseSample* pose);

}  // namespace kestrel
