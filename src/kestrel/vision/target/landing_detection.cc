// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/target/landing_detection.h"

namespace kestrel {

const char* ToString(DetectionMethod method) {
  switch (method) {
    case DetectionMethod::kQuadrants:
      return "quadrants";
    case DetectionMethod::kThinning:
      return "thinning";
    case DetectionMethod::kLines:
      return "lines";
    case DetectionMethod::kPartial:
      return "partial";
    case DetectionMethod::kTags:
      return "tags";
    case DetectionMethod::kLetter:
      return "letter";
    case DetectionMethod::kFollowed:
      return "followed";
    case DetectionMethod::kOther:
      return "other";
  }
  return "";
}

const char* ToString(LandingStage stage) {
  switch (stage) {
    case LandingStage::kBinarize:
      return "binarize";
    case LandingStage::kAreas:
      return "areas";
    case LandingStage::kRing:
      return "ring";
    case LandingStage::kCross:
      return "cross";
    case LandingStage::kMatch:
      return "match";
    case LandingStage::kLocate:
      return "locate";
    case LandingStage::kFound:
      return "found";
  }
  return "";
}

}  // namespace kestrel
