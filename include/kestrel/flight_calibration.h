// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The calibration of a camera's mount angles and clock offset from the sightings and poses of a
// flight.
//
// Example:
//   std::vector<TargetSighting> sightings;  // of the detections of a flight
//   std::vector<PoseSample> poses;          // of its navigation
//   const MountAndClock given{.body_from_camera = {}};
//   const FlightCalibration found = CalibrateFlight(sightings, poses, given, {});
//   std::cout << found.estimate.clock_offset_s << " s\n";

#include "kestrel/calibration/mount/flight_calibration.h"  // IWYU pragma: export
