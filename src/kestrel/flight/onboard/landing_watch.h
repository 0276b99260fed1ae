// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/autopilot_status.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/session/flight_end.h"

namespace kestrel {

// State at an instant that shows whether the UAV flies, and where it is. World frame, m and m/s.
struct LandingWatchInput {
  Time now;
  bool is_armed = false;
  LandedState state = LandedState::kUnknown;
  int reboots = 0;  // how often the autopilot has rebooted since the program began
  Time stamped;     // when the newest message with the autopilot's time since boot came

  struct Body {
    Eigen::Vector3d feet;
    Eigen::Vector3d velocity;
  };
  std::optional<Body> body;  // nothing: no pose is known
  struct Pattern {
    Eigen::Vector3d position;  // predicted to now
    Eigen::Matrix3d covariance;
  };
  std::optional<Pattern> pattern;  // nothing: never seen, or lost for good
  // The feet as the newest frame with the pattern showed them, from the pattern's centre, z
  // upwards: it needs no pose.
  struct Sight {
    Time time;
    Eigen::Vector3d feet;
  };
  std::optional<Sight> sight;                // nothing: never seen
  std::optional<double> heading_error = {};  // FlightEnd::heading_error, now

  bool has_contact = false;  // somebody has felt the pattern under the feet
  std::string gave_up;       // why guidance has given up; empty: it has not
};

// Judges how a flight ends: the UAV is down when it is disarmed after it was in the air, unless the
// autopilot has restarted, after which it is disarmed wherever it is. Where it is down follows from
// the feet and the predicted pattern at touch-down, the last moment at which the UAV still rose or
// sank: later the camera sees nothing any more, and a pattern on a vehicle drives on. Where the
// autopilot has lost its position, or it jumps, the newest frame shows where the UAV came down.
class LandingWatch {
 public:
  // 'pattern_radius_m': so far from its centre it is still on the pattern; 0: there is no pattern.
  explicit LandingWatch(double pattern_radius_m) : pattern_radius_m_(pattern_radius_m) {}

  // Call it often, in order of time, while the autopilot is heard.
  void Observe(const LandingWatchInput& input);

  // The end of the flight, once it is certain: a moment after the disarming, in which the autopilot
  // must show that it has not restarted.
  const std::optional<FlightEnd>& end() const { return end_; }

 private:
  // Feet relative to the pattern; standard deviations per axis.
  struct Place {
    double offset_m = 0;
    double height_m = 0;
    double offset_sigma_m = 0;
    double height_sigma_m = 0;
    std::optional<double> heading_error = {};
  };

  void Fly(const LandingWatchInput& input);
  void RememberSpeed(Time now, double speed_mps);
  bool IsCertain(const LandingWatchInput& input) const;
  FlightEnd Judge(const LandingWatchInput& input) const;
  FlightEnd JudgePlace() const;
  std::string WhySightCounts(const FlightEnd& by_place) const;

  double pattern_radius_m_;
  bool has_flown_ = false;
  std::optional<double> armed_z_m_;  // height of the feet at arming; nothing: not armed
  int reboots_ = 0;                  // before the flight
  std::optional<Time> seen_;         // when the pattern's place was known last
  double seen_offset_m_ = 0;         // at that time
  std::optional<Place> place_;       // at touch-down
  Time touched_down_{};
  double fastest_mps_ = 0;  // largest vertical speed, forgotten within seconds
  Time last_{};
  std::optional<LandingWatchInput::Sight> sight_;  // the newest before the disarming
  bool has_body_ = false;                          // at the newest instant in flight
  std::optional<Time> on_ground_;                  // since when, by contact or by the autopilot
  std::optional<Time> disarmed_;
  std::optional<FlightEnd> end_;
};

}  // namespace kestrel
