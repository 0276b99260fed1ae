// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace kestrel {

// Request to the autopilot beside the set-points. It is repeated for as long as it holds: the
// caller limits how often it is sent.
enum class GuidanceRequest {
  kNone,
  kLand,    // its LAND mode, in contact
  kHold,    // LOITER or HOLD: guidance has given up
  kDisarm,  // by force, in contact
};
const char* ToString(GuidanceRequest request);  // "none", "land", "hold", "disarm"

}  // namespace kestrel
