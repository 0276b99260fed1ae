// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/poses/pose_history.h"

namespace kestrel {

// What a calibration file calls it: "equidistant", "radial-tangential" or "none".
const char* DistortionName(DistortionModel model);

// cam0/sensor.yaml of a recording in the EuRoC layout: lens, size, rate and, where the calibration
// has one, the mount T_BS. ReadCalibration reads it back, to the last bit.
std::string EurocCameraText(const CameraCalibration& calibration, double rate_hz);

// The same with the clock offset, where the calibration has one.
std::string EurocCalibrationText(const CameraCalibration& calibration, double rate_hz);

// nav0/sensor.yaml.
std::string EurocPoseSensorText(double rate_hz);

// The columns of a pose's file, without the end of the line, and a row of it: position (to a
// micrometre) and quaternion (w x y z). 'frames': the two in their names, "WB" in nav0, "RS" in
// EuRoC's ground truth.
std::string EurocPoseColumns(const std::string& frames);
std::string EurocPoseCells(Time time, const RigidTransform& pose);

// nav0/data.csv: the body in the world.
std::string EurocPoseText(const std::vector<PoseSample>& poses);

// A matrix as EuRoC files have it, rows in a flat list: "  cols: 4\n  rows: 4\n  data: [...]\n".
std::string EurocTransformText(const RigidTransform& transform);

}  // namespace kestrel
