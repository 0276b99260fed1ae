// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "kestrel/simulation/autopilots/simulated_uav.h"

namespace kestrel {

// How a landing went.
struct SitlResult {
  std::optional<Contact> contact;  // in a mode that lands, or that is guided
  double landing_s = 0;            // from the switch to the first such mode until contact
  bool is_disarmed = false;        // after contact, not by force
  double disarm_s = 0;             // from contact

  // Of the mode that is guided by set-points.
  double guided_s = 0;       // how long it was on
  int set_points = 0;        // that came in it
  int guided_entries = 0;    // how often it began
  int modes_by_link = 0;     // how often the companion asked for a mode
  bool was_forced = false;   // the companion stopped the motors by force
  std::optional<Time> left;  // when it was left last, for whatever mode
  // Set-points that came after it was left, and the last of them so long after.
  int set_points_after_take_back = 0;
  double last_set_point_after_s = 0;

  // Of the feet's middle from the pattern's centre, m; only with a contact.
  double offset_m() const { return contact->feet_in_pattern.head<2>().norm(); }
};

// Lines: "came down on the board, 0.03 m from the centre, after 18.2 s; disarmed 2.1 s later", and
// how it was guided, if it was.
std::string InWords(const SitlResult& result);

}  // namespace kestrel
