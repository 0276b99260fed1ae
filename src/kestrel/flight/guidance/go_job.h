// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace kestrel {

// The UAV's action at an object.
enum class GoAction {
  kHover,  // stays above it
  kLook,   // as well, while pictures are kept
  kDrop,   // opens the gripper
  kPick,   // closes the gripper, and looks whether the object is gone
};

// Goal of a job.
enum class GoTarget {
  kObject,  // of the map
  kMarked,  // what a person has marked, once the flight to it is confirmed
  kPlace,   // where nothing has to be seen
};

// An action, the height of the feet above the object at which it is done, and how long it takes
// there (of a gripper: after the autopilot's answer).
struct GoJob {
  GoTarget target = GoTarget::kObject;
  GoAction action = GoAction::kHover;
  double height_m = 2.5;
  double seconds = 10;
  // After a pick the UAV takes the object to a box, and then goes on to the next one.
  bool delivers = false;

  bool grips() const { return action == GoAction::kDrop || action == GoAction::kPick; }
  // The gripper must be exactly there. A place is not known to centimetres.
  bool is_exact() const { return grips() && target != GoTarget::kPlace; }
};

// Reads "ACTION[,HEIGHT[,SECONDS]]", as "pick" or "hover,3,20". Throws InputError for another text.
GoJob ParseGoJob(std::string_view text);

}  // namespace kestrel
