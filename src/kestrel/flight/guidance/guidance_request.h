// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace kestrel {

// Request to the autopilot beside the set-points. It is repeated for as long as it holds: the
// caller limits how often it is sent.
enum class GuidanceRequest {
  kNone,
  kLand,      // its LAND mode, in contact
  kHold,      // LOITER or HOLD: guidance has given up
  kDisarm,    // by force, in contact
  kGrab,      // the gripper closes
  kRelease,   // the gripper opens
  kAltitude,  // ALT_HOLD or Altitude: the pilot flies on, without a position
};
// "none", "land", "hold", "disarm", "grab", "release", "altitude"
const char* ToString(GuidanceRequest request);

}  // namespace kestrel
