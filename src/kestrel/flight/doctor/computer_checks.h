// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"

namespace kestrel {

// Measures the state of this computer. 'record': folder of the recording, empty: none. 'root':
// where /sys and /dev are.
ComputerObservations ObserveComputer(const std::string& record,
                                     const std::filesystem::path& root = "/");

// Returns how fast files of a recording can be written, MB/s: writes and removes a file of 8 MB.
// Nothing: none can be made there.
std::optional<double> MeasureDisk(const std::string& record);

// Checks of the computer and of its computing time.
Finding CheckDetectionTime(const DoctorObservations& observations);  // against the frames' period
Finding CheckLoad(const ComputerObservations& computer);
Finding CheckHeat(const ComputerObservations& computer);
Finding CheckPower(const ComputerObservations& computer);
Finding CheckDisk(const DoctorObservations& observations);
Finding CheckTimeOfDay(const ComputerObservations& computer);

std::vector<Finding> CheckComputer(const DoctorObservations& observations);

}  // namespace kestrel
