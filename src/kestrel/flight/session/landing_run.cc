// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/landing_run.h"

#include <cmath>

#include <fmt/format.h>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/pipeline/calibration_monitor.h"
#include "kestrel/vision/pipeline/require_altitude.h"
#include "kestrel/vision/pipeline/told_contradictions.h"

namespace kestrel {
namespace {

std::string AttitudeWarning(const Contradiction& tilt) {
  return fmt::format(
      "the attitude says that the pattern is tilted by {:.0f} degrees (median of {} frames): {}"
      "check the mount (kestrel calibrate mount) and the navigation's attitude",
      Degrees(tilt.difference), tilt.detections,
      tilt.difference > kPi / 2 ? "is the camera mounted upside down? " : "");
}

}  // namespace

LandingRun::LandingRun(const OpenedSource& opened, const LandingPipelineOptions& options,
                       std::optional<double> altitude_m)
    : pipeline_(opened.calibration, options),
      clock_offset_(opened.calibration.clock_offset.value_or(Duration::zero())),
      altitude_m_(altitude_m),
      has_world_(opened.has_world()),
      is_lens_unknown_(opened.is_lens_unknown) {
  RequireAltitude(altitude_m);
  pipeline_.SetAltitude(altitude_m);
}

Observation LandingRun::Process(const Frame& frame) {
  LandingObservation seen = pipeline_.Process(frame.image, frame.time);
  ++poses_[seen.pose];
  found_ += seen.report.detection.has_value();
  other_tag_ = seen.other_tag;
  return {frame, std::move(seen)};
}

std::string LandingRun::Warning() const {
  if (const auto tilt = pipeline_.contradictions().Attitude()) return AttitudeWarning(*tilt);
  const auto excess = pipeline_.contradictions().Altitude();
  if (!excess) return "";
  const std::string what = fmt::format(
      "the given altitude is {:.1f} m {} the one that the pattern shows (median of {} frames, "
      "standard deviation {:.1f} m): ",
      std::abs(excess->difference), excess->difference > 0 ? "above" : "below", excess->detections,
      excess->sigma);
  if (has_world_) {
    return fmt::format(
        "{}set landing.target_height_m={:.1f}, or correct the navigation's z or the pattern's size",
        what, pipeline_.options().target_height_m + excess->difference);
  }
  return fmt::format("{}set --altitude {:.1f}, or correct the pattern's size", what,
                     altitude_m_.value_or(0) - excess->difference);
}

std::string LandingRun::Found() const {
  return fmt::format("pattern found in {}{}", found_,
                     other_tag_ ? fmt::format(" ({})", InWords(*other_tag_)) : "");
}

std::string LandingRun::Remarks() const {
  const double focal_px = pipeline_.detector().camera().intrinsics().fx_px;
  std::string remarks;
  if (!is_lens_unknown_) remarks = LensWarning(pipeline_.calibration_monitor(), focal_px);
  if (!remarks.empty()) remarks += "\n";
  // Only where there are poses for some of the frames; a source without any is not unusual.
  for (const auto& [pose, count] : poses_) {
    if (pose == PoseLookup::kFound || pose == PoseLookup::kEmpty ||
        pose == PoseLookup::kPredicted) {
      continue;
    }
    remarks += fmt::format("{} frames without a pose of the UAV: {}\n", count, ToString(pose));
  }
  return remarks;
}

}  // namespace kestrel
