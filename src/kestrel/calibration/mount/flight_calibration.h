// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"

namespace kestrel {

// A detection of the target by the camera.
struct TargetSighting {
  Time time;  // on the clock of the images
  Eigen::Vector3d center_in_camera;
  double sigma_m;  // standard deviation per axis, positive
};

// The relation of the camera to the navigation: its mount and the clocks. Of a camera on a gimbal:
// its place on the platform, and the clock of the gimbal in place of that of the navigation.
struct MountAndClock {
  RigidTransform body_from_camera;
  double clock_offset_s = 0;  // t_nav = t_image + clock_offset_s
};

// The gimbal of a flight.
struct FlownGimbal {
  RigidTransform body_from_pivot;
  std::vector<GimbalSample> reports;
  double image_clock_offset_s = 0;  // t_nav = t_image + this, which is held
};

struct FlightCalibrationOptions {
  bool estimate_mount = true;
  bool estimate_clock = true;
  // 0: the target stands. Else it moves along a curve with a knot each so many seconds.
  double knot_spacing_s = 0;
  // The grid of the search (paper, section 2.6): angles to both sides of the given mount, and
  // offsets.
  double max_angle_deg = 6;
  double angle_step_deg = 1;
  double min_offset_s = -0.1;
  double max_offset_s = 0.3;
  double offset_step_s = 0.02;
};

// Distance of a sighting's position in the world from the path.
struct SightingResidual {
  Time time;            // time of the sighting
  double before_m = 0;  // with the given values
  double after_m = 0;   // with the estimate
};

// Motion of the UAV while it saw the target, by which mount and clock differ from the place of the
// target.
struct FlightMotion {
  double turn = 0;           // largest difference of two headings, rad, to pi
  double tilt = 0;           // largest angle between the body's z axis and the vertical, rad
  double height_span_m = 0;  // largest difference of two heights
};

struct FlightCalibration {
  MountAndClock estimate;
  // Roll, pitch, yaw (rad) of the mount relative to the given one: Rz Ry Rx, in the body's frame.
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();
  // Standard deviations, from the residuals of the positions and their correlation from image to
  // image; 0: not estimated.
  Eigen::Vector3d angle_sigmas = Eigen::Vector3d::Zero();
  double clock_sigma_s = 0;
  double rms_before_m = 0;  // distance of the world positions from the path, with the given values
  double rms_after_m = 0;
  std::vector<SightingResidual> residuals;  // for the sightings that were used
  int sightings = 0;                        // number used
  int outliers = 0;                         // number left out
  FlightMotion motion;
  // Quantities that the flight determines poorly, in words.
  std::vector<std::string> warnings;
};

// Returns the mount angles and the clock offset with which the positions of the target in the world
// fit one path best (paper, section 2.6): a grid search, then least squares over all of them
// without the sightings that do not fit. With a gimbal the attitude is that of its reports. Throws
// InputError when too few sightings have poses around them.
FlightCalibration CalibrateFlight(const std::vector<TargetSighting>& sightings,
                                  const std::vector<PoseSample>& poses, const MountAndClock& given,
                                  const FlightCalibrationOptions& options,
                                  const std::optional<FlownGimbal>& gimbal = std::nullopt);

// Returns why a calibration is not to be used, in words: a quantity that the flight does not
// determine and what the flight lacks, or positions that agree less than before. Empty: it may be
// used.
std::string WhyOfNoUse(const FlightCalibration& result);

}  // namespace kestrel
