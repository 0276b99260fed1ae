// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kestrel/simulation/autopilots/object_field.h"
#include "kestrel/simulation/autopilots/simulated_uav.h"

namespace kestrel {

// The outcome of a landing, or of a flight to an object.
struct SitlResult {
  std::optional<Contact> contact;  // in a landing mode, or in the guided mode
  double landing_s = 0;            // from the switch to the first such mode until contact
  bool is_disarmed = false;        // after contact, not by force
  double disarm_s = 0;             // from contact

  // These are about the mode guided by set-points.
  double guided_s = 0;       // time that it was on
  int set_points = 0;        // that came while it was on
  int guided_entries = 0;    // number of times that it began
  int modes_by_link = 0;     // number of modes requested by the companion
  bool was_forced = false;   // the companion stopped the motors by force
  std::optional<Time> left;  // end of the guided mode, to any other mode
  // Set-points after its end, and the time of the last of them after it.
  int set_points_after_take_back = 0;
  double last_set_point_after_s = 0;

  bool has_left_room = false;  // it has touched a wall or the ceiling

  // These are about the gripper.
  int grabs = 0;                               // number of times that it was closed
  std::optional<ObjectField::Grab> grab;       // the last one; nothing: there were no objects
  std::optional<Eigen::Vector3d> released_at;  // where it was opened last, m in the world
  bool holds_object = false;
  std::vector<Eigen::Vector3d> put_down;  // where it was opened with an object, m in the world

  // Distance of the feet's middle from the pattern's centre, m; only with a contact.
  double offset_m() const { return contact->feet_in_pattern.head<2>().norm(); }
};

// Returns lines: "came down on the board, 0.03 m from the centre, after 18.2 s; disarmed 2.1 s
// later", and summaries of the guidance and the gripper, if there was any.
std::string InWords(const SitlResult& result);

}  // namespace kestrel
