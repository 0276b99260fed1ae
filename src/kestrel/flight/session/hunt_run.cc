// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/hunt_run.h"

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/vision/objects/color/color_grid.h"
#include "kestrel/vision/pipeline/ground_height.h"
#include "kestrel/vision/pipeline/require_altitude.h"

namespace kestrel {

namespace {

// Returns nothing for an image without any contrast, which says nothing of the camera.
std::optional<bool> IsColored(const cv::Mat& image) {
  cv::Mat channels[3];
  cv::split(image, channels);
  if (cv::norm(channels[0], channels[1], cv::NORM_INF) > 0 ||
      cv::norm(channels[1], channels[2], cv::NORM_INF) > 0) {
    return true;
  }
  double low = 0, high = 0;
  cv::minMaxLoc(channels[0], &low, &high);
  return low == high ? std::nullopt : std::optional(false);
}

}  // namespace

HuntRun::HuntRun(const OpenedSource& opened, const ObjectModel& model, const ColorGrid& grid,
                 const HuntPipelineOptions& options, std::optional<double> altitude_m)
    : pipeline_(opened.calibration, model, grid, options),
      clock_offset_(opened.calibration.clock_offset.value_or(Duration::zero())),
      altitude_m_(altitude_m) {
  RequireAltitude(altitude_m);
  pipeline_.SetAltitude(altitude_m);
}

// The last row of a rolling shutter is exposed later than the frame's time.
Duration HuntRun::pose_lead() const {
  return clock_offset_ + DurationFromSeconds(pipeline_.options().readout_s / 2);
}

Observation HuntRun::Process(const Frame& frame) {
  if (!is_colored_) {
    const std::optional<bool> colored = IsColored(frame.image);
    if (colored == false) {
      throw InputError(frame.name + ": is a gray image, expected images in colour to hunt in");
    }
    is_colored_ = colored.has_value();
  }
  const HuntObservation& seen = pipeline_.Process(frame.image, frame.time);
  detections_ += seen.report.detections.size();
  for (std::size_t i = 0; i < kObjectStageCount; ++i) passed_[i] += seen.report.passed[i];
  has_world_ = seen.world_from_camera.has_value();
  return {frame, seen};
}

std::string HuntRun::Warning() const {
  const std::optional<GroundHeight> higher = pipeline_.ground_contradiction();
  if (!higher) return "";
  if (!has_world_) {
    return fmt::format(
        "by the size of the objects the camera is {0:.2f} m above the ground (standard deviation "
        "{1:.2f} m), --altitude says {2:g} m: set --altitude {0:.2f}",
        *altitude_m_ - higher->height_m, higher->sigma_m, *altitude_m_);
  }
  const double ground_m = pipeline_.options().ground_height_m;
  return fmt::format(
      "by the size of the objects the ground is at z = {0:.2f} m of the navigation's world "
      "(standard deviation {1:.2f} m), hunt.ground_height_m says {2:g} m: set "
      "hunt.ground_height_m={0:.2f}, or correct the navigation's z, its clock or the camera's "
      "mount",
      ground_m + higher->height_m, higher->sigma_m, ground_m);
}

std::string HuntRun::Found() const { return fmt::format("{} detections", detections_); }

std::string HuntRun::Remarks() const {
  std::string remarks = "segments";
  for (std::size_t i = 0; i < kObjectStageCount; ++i) {
    remarks += fmt::format("{} {} {}", i == 0 ? "" : ",", passed_[i],
                           ToString(static_cast<ObjectStage>(i)));
  }
  return remarks + "\n";
}

}  // namespace kestrel
