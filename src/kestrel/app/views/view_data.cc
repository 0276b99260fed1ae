// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/views/view_data.h"

namespace kestrel {

const char* ToString(OverlayLayer layer) {
  switch (layer) {
    case OverlayLayer::kDetection:
      return "detection";
    case OverlayLayer::kPrediction:
      return "prediction";
    case OverlayLayer::kRejected:
      return "rejected";
    case OverlayLayer::kTruth:
      return "truth";
    case OverlayLayer::kSecond:
      return "second";
  }
  return "";
}

const char* ToString(ValueSource source) {
  static constexpr const char* kNames[] = {"frames", "autopilot", "pose"};
  return kNames[static_cast<int>(source)];
}

}  // namespace kestrel
