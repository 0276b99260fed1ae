// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/base/limits.h"
#include "kestrel/flight/guidance/contact_detector.h"
#include "kestrel/flight/guidance/flight_limits.h"
#include "kestrel/flight/guidance/flight_model.h"
#include "kestrel/flight/guidance/follow_options.h"
#include "kestrel/flight/guidance/stale_safety.h"

namespace kestrel {

struct GuidanceOptions {
  // Further away than follow_height_m the UAV flies higher, by this per metre of distance.
  static constexpr double kGlide = 0.7;
  // Integral part, 1/s^2: it removes the rest of the offset that wind and curve leave.
  static constexpr double kIntegralGain = 0.2;
  // Time constant of the smoothed target velocity. A vehicle sways on its springs faster than a UAV
  // can follow.
  static constexpr double kSmoothing_s = 0.5;
  // Speed of the descent per metre of height, 1/s; growth of the descent cone's radius per metre.
  static constexpr double kSinkGain = 0.8;
  static constexpr double kConeSlope = 0.35;
  // Age of the last sighting up to which a committed landing continues.
  static constexpr double kCommitSight_s = 1;
  // A target that rises or sinks faster is not credible.
  static constexpr double kMaxTargetClimb_mps = 1;
  static constexpr double kHoldPose_s =
      0.3;  // duration of level flight without a pose, before it stands still
  // When the velocity differs from the commanded one by more than kDisobey_mps and comes no nearer
  // to it for kDisobey_s, the autopilot does not obey.
  static constexpr double kDisobey_mps = 3;
  static constexpr double kDisobey_s = 3;

  double leg_m = 0.35;
  double search_altitude_m = 10;
  double search_wait_s = 15;
  double search_radius_m = 0;
  double search_speed_mps = 4;
  double search_distance_m = 100;
  double search_limit_s = 60;
  double cannot_follow_s = 0;
  double follow_height_m = 2.5;
  double position_gain = 2.5;
  double braking = 3;
  double autopilot_jerk = 0;
  double touchdown_sink_mps = 0.7;
  double cone_m = 0.15;
  double commit_height_m = 0.35;
  std::string touchdown_heading = "any";
  double heading_tolerance_deg = 2;
  double heading_wait_s = 20;
  double max_turn_dps = 30;
  double max_sigma_m = 0.25;
  double sight_s = 0.5;
  double sight_height_m = 2;
  double lose_pose_s = 1;
  double lose_camera_s = 10;
  double lose_link_s = 0.8;
  bool stream_before_start = false;
  bool land_in_contact = false;
  double disarm_after_s = 0;
  double disarm_carried_s = 3;
  bool accept_unsafe_loss = false;
  FollowOptions follow;
  ContactOptions contact;
  StaleOptions stale;
  FlightLimitsOptions limits;
  FlightModelOptions model;
  bool target_is_agile = false;  // its velocity changes as it likes; no option of the user

  static void Visit(auto& self, auto&& visit) {
    visit("leg_m", self.leg_m, Range{0, 2}, "from the body's origin down to the feet");
    visit("search_altitude_m", self.search_altitude_m, Range{1, 100},
          "height above ground of the search; lower for a pad that is not seen from there");
    visit("search_wait_s", self.search_wait_s, Range{0, 3600},
          "time at the search point before the UAV circles outwards");
    visit("search_radius_m", self.search_radius_m, Range{0, 1000},
          "largest radius of the search spiral; 0: none");
    visit("search_speed_mps", self.search_speed_mps, Range{0.5, 20}, "speed on the search spiral");
    visit("search_distance_m", self.search_distance_m, Range{1, 10000},
          "distance to which a lost target is searched for");
    visit("search_limit_s", self.search_limit_s, Range{1, 3600},
          "time after which the search for a lost target is given up");
    visit("cannot_follow_s", self.cannot_follow_s, Range{0, 3600},
          "time beyond the limits after which guidance gives up; 0: never");
    visit("follow_height_m", self.follow_height_m, Range{0.1, 100},
          "height above the board when following");
    visit("position_gain", self.position_gain, Range{0.1, 5},
          "[1/s] speed to the target per metre");
    visit("braking", self.braking, Range{0.1, 20},
          "[m/s^2] assumed deceleration of the UAV far from the target");
    visit("autopilot_jerk", self.autopilot_jerk, Range{0, 1000},
          "[m/s^3] the autopilot's jerk; 0: unlimited");
    visit("touchdown_sink_mps", self.touchdown_sink_mps, Range{0.1, 10}, "slowest descent");
    visit("cone_m", self.cone_m, Range{0.01, 10}, "radius of the descent cone at the board");
    visit("commit_height_m", self.commit_height_m, Range{0, 1},
          "height below which the UAV lands for good");
    visit("touchdown_heading", self.touchdown_heading,
          "[deg] heading of the nose over the pad, from the pad's x axis, counterclockwise from "
          "above; "
          "or any");
    visit("heading_tolerance_deg", self.heading_tolerance_deg, Range{0.5, 45},
          "largest heading error at which the UAV commits to the landing");
    visit("heading_wait_s", self.heading_wait_s, Range{1, 3600},
          "time above the target without that heading after which guidance gives up");
    visit("max_turn_dps", self.max_turn_dps, Range{1, 360},
          "largest turn rate to that heading, relative to the pad");
    visit("max_sigma_m", self.max_sigma_m, Range{0.01, 10},
          "largest standard deviation of the target's position for a descent; above twice this: "
          "climb");
    visit("sight_s", self.sight_s, Range{0.05, kCommitSight_s},
          "age of the last sighting up to which the target is in sight");
    visit("sight_height_m", self.sight_height_m,
          "height below which the UAV climbs when the target is out of sight");
    visit("lose_pose_s", self.lose_pose_s, Range{kHoldPose_s, 10},
          "time without a pose after which guidance gives up");
    visit("lose_camera_s", self.lose_camera_s, Range{0.05, 3600},
          "time without images after which guidance gives up");
    visit("lose_link_s", self.lose_link_s, Range{0.1, 10},
          "link outage after which guidance waits for the mode and goes around");
    visit("stream_before_start", self.stream_before_start,
          "send set-points of standing still before the mode is given");
    visit("land_in_contact", self.land_in_contact, "request the LAND mode in contact");
    visit("disarm_after_s", self.disarm_after_s, Range{0, 60},
          "time in contact after which the UAV is disarmed by force; 0: never");
    visit("disarm_carried_s", self.disarm_carried_s, Range{0, 60},
          "the same, for time with proof that a deck carries the UAV; 0: never");
    visit("accept_unsafe_loss", self.accept_unsafe_loss,
          "fly although the autopilot does not hold when set-points stop");
    visit.Group("follow", self.follow);
    visit.Group("stale", self.stale);
    visit.Group("limits", self.limits);
    visit.Group("model", self.model);
    visit.Gone({"glide", "integral_gain", "smoothing_s", "sink_gain", "cone_slope",
                "commit_sight_s", "max_target_climb_mps", "hold_pose_s", "disobey_mps", "disobey_s",
                "contact"});
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
