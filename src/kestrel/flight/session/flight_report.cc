// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/flight_report.h"

namespace kestrel {

const char* ToString(TargetPhase phase) {
  switch (phase) {
    case TargetPhase::kSearching:
      return "searching";
    case TargetPhase::kFound:
      return "found";
    case TargetPhase::kLost:
      return "lost";
    case TargetPhase::kContact:
      return "contact";
  }
  return "";
}

}  // namespace kestrel
