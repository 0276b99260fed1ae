// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/guidance_phase.h"

namespace kestrel {

const char* ToString(GuidancePhase phase) {
  switch (phase) {
    case GuidancePhase::kIdle:
      return "idle";
    case GuidancePhase::kSearch:
      return "search";
    case GuidancePhase::kApproach:
      return "approach";
    case GuidancePhase::kFollow:
      return "follow";
    case GuidancePhase::kDescend:
      return "descend";
    case GuidancePhase::kCommit:
      return "commit";
    case GuidancePhase::kGoAround:
      return "go-around";
    case GuidancePhase::kLanded:
      return "landed";
    case GuidancePhase::kLook:
      return "look";
    case GuidancePhase::kAct:
      return "act";
  }
  return "";
}

}  // namespace kestrel
