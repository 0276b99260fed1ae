// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/io/recording/media/image_sequence.h"

namespace kestrel {

// One row of cam0/data.csv.
struct ImageRow {
  Time time;
  std::string filename;  // below cam0/data
};

// Parse the texts of cam0/data.csv and nav0/data.csv; 'file' is their name for messages. Columns
// are found by their names, further columns are ignored. Throw InputError with the line for numbers
// that are not finite, times that do not increase, and quaternions that do not have unit length (to
// 1 %; smaller differences are rounding and are normalised). 'frames': the two frames in the names
// of the pose's columns, "WB" in nav0, "RS" in EuRoC's ground truth.
std::vector<ImageRow> ParseImageRows(std::string_view text, const std::string& file);
std::vector<PoseSample> ParsePoseRows(std::string_view text, const std::string& file,
                                      const std::string& frames = "WB");
// Parses the text of gimbal0/data.csv, with the yaw frame that sensor.yaml says, in the same way.
std::vector<GimbalSample> ParseGimbalRows(std::string_view text, const std::string& file,
                                          YawFrame yaw_frame);
// Parses the text of zoom0/data.csv.
std::vector<ZoomSample> ParseZoomRows(std::string_view text, const std::string& file);

// Returns the folder of cam0: 'folder' itself, its mav0, or the folder in which the camera's folder
// 'folder' is; nothing when it is not a recording.
std::optional<std::string> FindEurocRoot(const std::string& folder);

// Returns the names of a recording's cameras, cam0, cam1, ..., in this order. That of the camera
// alone where 'folder' is a camera's. Empty when it is not a recording.
std::vector<std::string> EurocCameras(const std::string& folder);

// Opens a camera of a recording in the EuRoC / ASL layout (data.csv, data/, sensor.yaml) and, if
// there, nav0/data.csv, gimbal0 (data.csv, sensor.yaml) and zoom0/data.csv. 'camera': its name;
// empty: the first of EurocCameras. Throws InputError when 'folder' is not a recording or its files
// are not valid.
ImageSequence OpenEurocRecording(const std::string& folder, const std::string& camera = "");

}  // namespace kestrel
