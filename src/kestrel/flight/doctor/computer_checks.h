// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"

namespace kestrel {

// Measures the state of this computer. 'record': folder of the recording, empty: none.
ComputerObservations ObserveComputer(const std::string& record);

// Checks of the computer and of its computing time.
Finding CheckDetectionTime(const DoctorObservations& observations);  // against the frames' period
Finding CheckLoad(const ComputerObservations& computer);
Finding CheckHeat(const ComputerObservations& computer);
Finding CheckDisk(const DoctorObservations& observations);

std::vector<Finding> CheckComputer(const DoctorObservations& observations);

}  // namespace kestrel
