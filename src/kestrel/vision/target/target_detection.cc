// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/target/target_detection.h"

namespace kestrel {

const char* ToString(DetectionMethod method) {
  switch (method) {
    case DetectionMethod::kRing:
      return "ring";
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

std::string_view MissInWords(const TargetReport& report, bool is_expected) {
  // An image without contrast, or one that is none of this camera, is no view of the ground at all.
  const bool is_view = report.reached > LandingStage::kBinarize;
  const bool is_like_pad = report.reached >= LandingStage::kLocate || report.is_another_pad;
  if (is_view && !is_like_pad && !is_expected) return "not in view";
  return report.reason;
}

}  // namespace kestrel
