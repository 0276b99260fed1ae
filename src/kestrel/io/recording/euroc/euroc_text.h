// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/core/poses/zoom_history.h"

namespace kestrel {

// Returns the name in calibration files: "equidistant", "radial-tangential" or "none".
const char* DistortionName(DistortionModel model);

// The place of the descriptions of a gimbal and a zoom: folders of the recording, gimbal0 and
// zoom0, or the camera's file.
enum class SensorPlace { kFolder, kCameraFile };

// Returns the text of cam0/sensor.yaml in the EuRoC layout: lens, size, rate and, if the
// calibration has one, the mount: T_BS, or T_GS on a gimbal. ReadCalibration reads it back exactly,
// to the last bit.
std::string EurocCameraText(const CameraCalibration& calibration, double rate_hz,
                            SensorPlace place = SensorPlace::kFolder);

// The same with the clock offset, if the calibration has one: a file of its own.
std::string EurocCalibrationText(const CameraCalibration& calibration, double rate_hz,
                                 SensorPlace place = SensorPlace::kCameraFile);

// Returns the text of gimbal0/sensor.yaml.
std::string EurocGimbalSensorText(const GimbalMount& gimbal, YawFrame yaw_frame, double rate_hz);

// Return the columns of gimbal0/data.csv, without the end of the line, and a row of it.
std::string EurocGimbalColumns();
std::string EurocGimbalCells(const GimbalSample& sample);

// Returns the text of gimbal0/data.csv.
std::string EurocGimbalText(const std::vector<GimbalSample>& samples);

// The same of zoom0.
std::string EurocZoomSensorText(const ZoomLens& zoom, double rate_hz);
std::string EurocZoomColumns();
std::string EurocZoomCells(const ZoomSample& sample);
std::string EurocZoomText(const std::vector<ZoomSample>& samples);

// Returns the text of nav0/sensor.yaml.
std::string EurocPoseSensorText(double rate_hz);

// Return the columns of a file of poses, without the end of the line, and a row of it: position (to
// a micrometre) and quaternion (w x y z). 'frames': the two frames in the names of the columns,
// "WB" in nav0, "RS" in EuRoC's ground truth.
std::string EurocPoseColumns(const std::string& frames);
std::string EurocPoseCells(Time time, const RigidTransform& pose);

// Returns the text of nav0/data.csv: poses of the body in the world.
std::string EurocPoseText(const std::vector<PoseSample>& poses);

// Returns a matrix in the form of EuRoC's files: "  cols: 4
//   rows: 4
//   data: [...]
// ", row by row.
std::string EurocTransformText(const RigidTransform& transform);

}  // namespace kestrel
