// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "kestrel/core/base/time.h"
#include "kestrel/vision/targets/make_target_detector.h"

namespace kestrel {

// The content of a recording's scene.yaml: facts about the whole recording and about single images.
// Missing keys leave the defaults; unknown keys are ignored.
struct SceneTruth {
  std::string condition = "all";  // light and weather
  double ring_diameter_m = 1;     // options.pattern.outer_diameter_m
  // Headings under which the pad looks the same, by options.target.kind; nothing: an unknown kind.
  std::optional<int> heading_symmetry = HeadingSymmetryOf("ring-cross");
  // R_BS_true = mount_error * R_BS_nominal: mount_error.yaw_deg, pitch_deg, roll_deg.
  Eigen::Quaterniond mount_error = Eigen::Quaterniond::Identity();
  double clock_offset_s = 0;         // time_offset_s: t_nav = t_image + offset
  std::optional<double> exposure_s;  // options.shutter.exposure_s

  // frames.<timestamp>.condition and .exposure_s, for images with values of their own.
  std::map<Time, std::string> frame_conditions;
  std::map<Time, double> frame_exposures_s;

  const std::string& ConditionAt(Time time) const;
  std::optional<double> ExposureAt(Time time) const;
};

// Throws InputError with file and key when the text is not YAML or a value is not a number.
SceneTruth ParseSceneTruth(const std::string& text, const std::string& file);

}  // namespace kestrel
