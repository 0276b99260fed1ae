// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kestrel/flight/guidance/contact_detector.h"
#include "kestrel/flight/guidance/flight_limits.h"
#include "kestrel/flight/guidance/flight_model.h"
#include "kestrel/flight/guidance/stale_safety.h"

namespace kestrel {

struct GuidanceOptions {
  double leg_m = 0.35;  // distance from the body's origin down to the feet
  // Search, without a target: flies to the place where the vehicle should pass or was last, at this
  // altitude above the world's z = 0 (lower: WithinSight). After search_wait_s there it flies a
  // spiral out to search_radius_m (0: it stays).
  double search_altitude_m = 10;
  double search_wait_s = 15;
  double search_radius_m = 0;
  double search_speed_mps = 4;
  // Search for a target that was lost: no further than search_distance_m from where it was lost,
  // and no longer than search_limit_s; guidance then gives up.
  double search_distance_m = 100;
  double search_limit_s = 60;
  // The target's motion and the wind may demand more than the limits: guidance gives up after so
  // long (0: never).
  double cannot_follow_s = 0;
  // Height of the feet above the board at which it follows the vehicle before the descent; further
  // away it flies higher, by 'glide' metres per metre of horizontal distance.
  double follow_height_m = 2.5;
  double glide = 0.7;
  // Speed towards the target: proportional to the distance near by (lower when the flight shows
  // that the autopilot is slow), and further away the highest from which it can still brake.
  double position_gain = 2.5;
  double braking = 3;
  // Jerk of the autopilot, i.e. how fast it changes the acceleration (m/s^3; 0: at once).
  // ArduCopter shapes commands by PSC_JERK_NE, which `fly` reads: a command that needs more makes
  // the UAV swing about the target.
  double autopilot_jerk = 0;
  // Integral part: speed per metre and second of offset. It removes the rest that wind and curve
  // leave.
  double integral_gain = 0.2;
  // Time constant of the smoothed target velocity. A vehicle sways on its springs faster than a UAV
  // can follow.
  double smoothing_s = 0.5;
  // It descends, in proportion to the height, while the target is within a cone: radius 'cone_m' on
  // the board, 'cone_slope' more per metre of height.
  double sink_gain = 0.8;
  double touchdown_sink_mps = 0.7;
  double cone_m = 0.15;
  double cone_slope = 0.35;
  // Below this height it commits: it goes down the last bit without the cone.
  double commit_height_m = 0.35;
  // Heading of the nose at touchdown: degrees from the pad's x axis, counterclockwise as seen from
  // above, or "any": the nose keeps its heading. Of the headings under which the pad looks the same
  // the nearest is taken. Until the nose has it within the tolerance the UAV does not commit; after
  // heading_wait_s above the target it gives up.
  std::string touchdown_heading = "any";
  double heading_tolerance_deg = 2;
  double heading_wait_s = 20;
  double max_turn_dps = 30;  // against the pad
  // While the target's standard deviation per axis is above this it does not descend; above twice
  // this it climbs.
  double max_sigma_m = 0.25;
  // The target is in sight when a frame showed it within sight_s. Out of sight the UAV does not
  // descend, and below sight_height_m it climbs; only in the last bit it may go on down for
  // commit_sight_s.
  double sight_s = 0.5;
  double sight_height_m = 2;
  double commit_sight_s = 1;
  // A target that rises or sinks faster is not credible.
  double max_target_climb_mps = 1;
  // Without a pose it flies on level for hold_pose_s, then stands still; after lose_pose_s it gives
  // up.
  double hold_pose_s = 0.3;
  double lose_pose_s = 1;
  // It gives up when the camera was away for so long.
  double lose_camera_s = 10;
  // When the link was away for longer than this it sends nothing until the autopilot has reported
  // its mode anew, and then goes around.
  double lose_link_s = 0.8;
  // When the velocity differs from the commanded one by more than disobey_mps and comes no nearer
  // to it for disobey_s, the autopilot does not obey.
  double disobey_mps = 3;
  double disobey_s = 3;
  // Streams set-points of standing still before the pilot gives the mode: PX4 does not enter
  // OFFBOARD without them.
  bool stream_before_start = false;
  // In contact: asks for the LAND mode (ArduPilot; PX4 would brake in it), and disarms by force
  // after disarm_after_s, or after disarm_carried_s of proof that the deck carries the UAV (0:
  // never).
  bool land_in_contact = false;
  double disarm_after_s = 0;
  double disarm_carried_s = 3;
  // Flies although the autopilot's own reaction to the loss of set-points does not hold the UAV.
  bool accept_unsafe_loss = false;
  ContactOptions contact;
  StaleOptions stale;
  FlightLimitsOptions limits;
  FlightModelOptions model;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("leg_m", self.leg_m, "m", "from the body's origin down to the feet");
    visitor("search_altitude_m", self.search_altitude_m, "m",
            "height above ground of the search; lower for a pad that is not seen from there");
    visitor("search_wait_s", self.search_wait_s, "s",
            "time at the search point before the UAV circles outwards");
    visitor("search_radius_m", self.search_radius_m, "m",
            "largest radius of the search spiral; 0: no spiral");
    visitor("search_speed_mps", self.search_speed_mps, "m/s", "speed on the search spiral");
    visitor("search_distance_m", self.search_distance_m, "m",
            "distance to which a lost target is searched for");
    visitor("search_limit_s", self.search_limit_s, "s",
            "time after which the search for a lost target is given up");
    visitor("cannot_follow_s", self.cannot_follow_s, "s",
            "time beyond the limits after which guidance gives up; 0: never");
    visitor("follow_height_m", self.follow_height_m, "m", "height above the board to follow in");
    visitor("glide", self.glide, "m/m", "height in approach, per metre of distance");
    visitor("position_gain", self.position_gain, "1/s", "speed towards the target per metre");
    visitor("braking", self.braking, "m/s^2",
            "assumed deceleration of the UAV far from the target");
    visitor("autopilot_jerk", self.autopilot_jerk, "m/s^3",
            "jerk limit of the autopilot; 0: unlimited");
    visitor("integral_gain", self.integral_gain, "1/s^2",
            "integral gain: speed per metre and second of offset");
    visitor("smoothing_s", self.smoothing_s, "s",
            "time constant of the filter of the target's velocity");
    visitor("sink_gain", self.sink_gain, "1/s", "speed of the descent per metre of height");
    visitor("touchdown_sink_mps", self.touchdown_sink_mps, "m/s", "slowest descent");
    visitor("cone_m", self.cone_m, "m", "radius of the descent cone at the board");
    visitor("cone_slope", self.cone_slope, "m/m", "growth of that radius per metre of height");
    visitor("commit_height_m", self.commit_height_m, "m",
            "height below which the UAV commits to the landing");
    visitor("touchdown_heading", self.touchdown_heading, "deg",
            "heading of the nose over the pad, from the pad's x axis, counterclockwise from above; "
            "or any");
    visitor("heading_tolerance_deg", self.heading_tolerance_deg, "deg",
            "largest heading error at which the UAV commits to the landing");
    visitor("heading_wait_s", self.heading_wait_s, "s",
            "time above the target without that heading after which guidance gives up");
    visitor("max_turn_dps", self.max_turn_dps, "deg/s",
            "largest turn rate to that heading, relative to the pad");
    visitor("max_sigma_m", self.max_sigma_m, "m",
            "largest standard deviation of the target's position for a descent");
    visitor("sight_s", self.sight_s, "s",
            "age of the last sighting up to which the target is in sight");
    visitor("sight_height_m", self.sight_height_m, "m",
            "height below which the UAV climbs when the target is out of sight");
    visitor("commit_sight_s", self.commit_sight_s, "s",
            "age of the last sighting up to which a committed landing continues");
    visitor("max_target_climb_mps", self.max_target_climb_mps, "m/s",
            "largest vertical speed of a target");
    visitor("hold_pose_s", self.hold_pose_s, "s", "time of level flight without a pose");
    visitor("lose_pose_s", self.lose_pose_s, "s",
            "time without a pose after which guidance gives up");
    visitor("lose_camera_s", self.lose_camera_s, "s",
            "time without images after which guidance gives up");
    visitor("lose_link_s", self.lose_link_s, "s",
            "link outage after which guidance waits for the mode and goes around");
    visitor("disobey_mps", self.disobey_mps, "m/s",
            "velocity error above which the autopilot does not obey");
    visitor("disobey_s", self.disobey_s, "s",
            "duration of that error after which guidance gives up");
    visitor("stream_before_start", self.stream_before_start, "",
            "send set-points of standing still before the mode is given");
    visitor("land_in_contact", self.land_in_contact, "", "ask for the LAND mode in contact");
    visitor("disarm_after_s", self.disarm_after_s, "s",
            "time in contact after which the UAV is disarmed by force; 0: never");
    visitor("disarm_carried_s", self.disarm_carried_s, "s",
            "the same, for time with proof that a deck carries the UAV; 0: never");
    visitor("accept_unsafe_loss", self.accept_unsafe_loss, "",
            "fly although the autopilot does not hold when set-points stop");
    visitor.Group("contact", self.contact);
    visitor.Group("stale", self.stale);
    visitor.Group("limits", self.limits);
    visitor.Group("model", self.model);
  }
  std::vector<std::string> Validate() const;

  // Returns these options for a target that is seen from 'range_m' at most: the search and the
  // approach fly no higher than 0.8 of that, but not below limits.floor_m. A search that flies
  // lower for that spirals out as far as it flies lower. 'range_m' is positive.
  GuidanceOptions WithinSight(double range_m) const;

  // Returns touchdown_heading in rad; nothing for "any", and for a text that is not valid.
  std::optional<double> HeadingOverPad() const;
};

}  // namespace kestrel
