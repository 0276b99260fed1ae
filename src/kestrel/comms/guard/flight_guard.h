// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/set_point.h"

namespace kestrel {

// Task of the guard when the program that flies is gone.
enum class GuardTask : std::uint8_t {
  kNothing,  // guidance does not fly
  kStop,     // guidance flies: the UAV is stopped and handed back
  kLower,    // guidance flies, and the position ends with the program, or is lost: see below
  kLand,     // in the last decimetres or on the deck: landing is requested
};

// Messages that the guard sends now.
struct GuardAction {
  std::optional<SetPoint> stop;    // a set-point that stops the UAV
  std::optional<float> level;      // a level attitude with this heading of NED, without climb
  std::optional<FlightMode> mode;  // a request for this mode
  const char* text = nullptr;      // to the ground station, up to 50 characters
};

// Decides what the guard does. A state machine without clock or socket: every event is
// passed to it. Neither throws nor allocates. docs/guard.md describes what it does in which case.
// A UAV that is lowered gets one level set-point, then LAND; or, where a pilot has his sticks in
// their middle, a mode that follows them. Nothing that needs a position is requested.
class FlightGuard {
 public:
  // 'patience': after so long without a sign of life the program that flies is taken for dead.
  explicit FlightGuard(Duration patience) : patience_(patience) {}

  // A sign of life of the program that flies, with what is to be done if it is the last one.
  // 'sent': when the program sent it, which counts where the guard itself was late.
  void TakeLife(GuardTask task, AutopilotKind kind, Time sent);
  // The program has ended, by itself or not: no more signs of life come.
  void TakeEnd() { has_ended_ = true; }
  // The autopilot reports whether it flies by set-points, and whether its motors run.
  void TakeMode(bool is_guided, Time now);
  void TakeArmed(bool is_armed) { is_armed_ = is_armed; }
  void TakeVelocity(const Eigen::Vector3d& velocity, Time now);  // ENU, m/s
  void TakeHeading(float heading);                               // NED, rad
  // The autopilot receives a transmitter, whose throttle is or is not in its middle.
  void TakeReceiver(bool is_received) { is_received_ = is_received; }
  void TakeThrottle(bool is_centred, Time now);
  void TakeRefusal();  // the autopilot refused a mode

  // Call it every 20 ms at most.
  GuardAction Update(Time now);

  // True from when the program is taken for dead while it flew: nothing of it is sent any more.
  bool has_taken_over() const { return has_taken_over_; }
  // True when the guard has nothing more to do.
  bool is_done() const { return state_ == State::kDone; }

 private:
  enum class State { kWatches, kWorks, kListens, kDone };

  GuardAction TakeOver(Time now);
  GuardAction Work(Time now);
  SetPoint Stop(Time now);
  bool HasPilot(Time now) const;
  std::optional<Eigen::Vector3d> Velocity(Time now) const;
  std::optional<FlightMode> ModeToRequest(Time now) const;
  GuardAction HandBack(const char* text, Time now);

  Duration patience_;
  State state_ = State::kWatches;
  GuardTask task_ = GuardTask::kNothing;
  AutopilotKind kind_ = AutopilotKind::kUnknown;
  Time life_{};  // the newest sign of life
  bool has_ended_ = false;
  bool has_taken_over_ = false;
  bool is_guided_ = true;  // true when guidance flies, until the autopilot reports otherwise
  bool is_armed_ = true;
  Time mode_reported_{};
  Eigen::Vector3d velocity_{0, 0, 0};
  std::optional<Time> velocity_reported_;
  std::optional<SetPoint> stop_;  // the last one
  std::optional<float> heading_;  // until the UAV was levelled
  bool is_received_ = false;
  std::optional<Time> throttle_centred_;  // when it was last
  bool is_refused_ = false;               // the mode wanted first
  Time since_{};                          // beginning of the state
  Time set_point_due_{};
  Time mode_due_{};
};

}  // namespace kestrel
