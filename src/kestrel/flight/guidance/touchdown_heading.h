// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/core/base/time.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {

struct GuidanceOptions;

// Turns the nose to the heading that the UAV is to have on the pad: an angle from the pad's x axis,
// which turns with the pad. Of the headings under which the pad looks the same it takes the one
// that needs the least turn. The turn has a limited rate and ends gently.
class TouchdownHeading {
 public:
  explicit TouchdownHeading(const GuidanceOptions& options);

  bool is_wanted() const { return over_pad_.has_value(); }

  // Begins anew, with the heading that the levelled nose has (rad from east to north).
  void Start(double yaw);

  // Turns on to 'now'. 'nose': the heading of the levelled nose (LevelHeadingOf), with which the
  // UAV will stand on the deck; 'link_delay_s': until the autopilot acts. Without a target, or one
  // whose heading is not known, the heading that was reached is kept.
  void Update(Time now, double nose, const std::optional<TargetEstimate>& target,
              double link_delay_s);

  // The heading to command now (rad), and the rate at which it turns (rad/s).
  double yaw() const { return yaw_; }
  double yaw_rate() const { return yaw_rate_; }

  // True when the target's heading is known.
  bool is_known() const { return is_known_; }
  // The nose's angle off the wanted heading at the last update, rad, counter-clockwise as seen from
  // above; nothing: none is wanted, or the target's is not known.
  const std::optional<double>& error() const { return error_; }
  // True when no heading is wanted, or the nose has it within the tolerance.
  bool is_reached() const;
  // True when it was neither reached nor not wanted for too long. The time counts while 'waits'.
  bool IsOverdue(Time now, bool waits);

 private:
  std::optional<double> over_pad_;  // rad; nothing: any heading
  double tolerance_;                // rad
  double max_rate_;                 // against the pad, rad/s
  double wait_s_;
  double yaw_ = 0;
  double yaw_rate_ = 0;
  bool is_known_ = false;
  std::optional<double> error_;
  std::optional<Time> last_;
  std::optional<Time> waits_since_;
};

}  // namespace kestrel
