// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/io/recording/image_sequence.h"

namespace kestrel {

// One row of cam0/data.csv.
struct ImageRow {
  Time time;
  std::string filename;  // below cam0/data
};

// The texts of cam0/data.csv and nav0/data.csv; 'file' is for messages. Columns are found by the
// name in the header, others are ignored. Throws InputError, with the line, for anything that is
// not a finite number, for times that do not increase and for quaternions that are not of unit
// length (to 1 %; the rest is rounding, and normalised). 'frames': the two frames in the names of
// the pose's columns, "WB" in nav0, "RS" in EuRoC's ground truth.
std::vector<ImageRow> ParseImageRows(std::string_view text, const std::string& file);
std::vector<PoseSample> ParsePoseRows(std::string_view text, const std::string& file,
                                      const std::string& frames = "WB");

// The folder in which cam0 lies: 'folder' itself or its mav0; nothing when it is no recording.
std::optional<std::string> FindEurocRoot(const std::string& folder);

// A recording in the EuRoC / ASL layout: cam0 (data.csv, data/, sensor.yaml) and, if there,
// nav0/data.csv. Throws InputError when 'folder' is no recording or its files are at fault.
ImageSequence OpenEurocRecording(const std::string& folder);

}  // namespace kestrel
