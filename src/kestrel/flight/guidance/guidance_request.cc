// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/guidance_request.h"

namespace kestrel {

const char* ToString(GuidanceRequest request) {
  switch (request) {
    case GuidanceRequest::kNone:
      return "none";
    case GuidanceRequest::kLand:
      return "land";
    case GuidanceRequest::kHold:
      return "hold";
    case GuidanceRequest::kDisarm:
      return "disarm";
    case GuidanceRequest::kGrab:
      return "grab";
    case GuidanceRequest::kRelease:
      return "release";
    case GuidanceRequest::kAltitude:
      return "altitude";
  }
  return "";
}

}  // namespace kestrel
