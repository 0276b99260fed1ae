// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace kestrel {

enum class GuidancePhase {
  kIdle,      // not begun, refused, or ended: the pilot flies
  kSearch,    // flies to where the vehicle was last or should pass, waits there, then circles
              // outwards
  kApproach,  // flies to above the target, or to beside what a person has marked
  kFollow,    // follows it there; at follow_height_m above a pad, until it may descend
  kDescend,   // descends above it
  kCommit,    // the last bit of the descent
  kGoAround,  // climbs again
  kLanded,    // in contact with the deck; stays so until guidance begins anew
  kLook,      // stands still and looks at what a person has marked, or whether an object is gone
  kAct,       // hovers above an object, or uses the gripper there
};
// "idle", "search", "approach", "follow", "descend", "commit", "go-around", "landed", "look", "act"
const char* ToString(GuidancePhase phase);

}  // namespace kestrel
