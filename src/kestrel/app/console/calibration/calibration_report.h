// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/app/console/messages/calibration_state.h"
#include "kestrel/calibration/lens/lens_calibration.h"
#include "kestrel/calibration/mount/flight_calibration.h"
#include "kestrel/calibration/mount/flight_sightings.h"
#include "kestrel/core/camera/calibration.h"

namespace kestrel {

// The calibration that the page requests: either the lens, or mount, clock or both.
struct CalibrationRequest {
  bool mount = false;
  bool clock = false;
  bool moving = false;  // the pattern moves; for mount and clock
  bool lens = false;

  // Name of the file that it is saved in: "mount", "clock", "mount_clock", "lens".
  std::string Name() const;
};

// Parses the words of a request: "lens", or "mount" and "clock" with or without "moving". Throws
// InputError for anything else.
CalibrationRequest ParseCalibrationRequest(const std::vector<std::string>& words);

// Returns the part of the report that describes what a flight covers. 'images': in the whole
// flight.
ConsoleCalibration FlightCoverage(const std::vector<PatternPlace>& places, std::size_t images,
                                  const cv::Size& image);

// Adds mount and clock to the report of a flight. 'given': the initial mount and clock.
void AddFlight(const FlightCalibration& result, const FlightCalibrationOptions& options,
               const MountAndClock& given, ConsoleCalibration* report);

// Returns the report on a lens. 'given': intrinsics of the recording, compared on the same views.
ConsoleCalibration LensReport(const LensCalibration& lens, const CameraIntrinsics& given,
                              std::size_t images);

}  // namespace kestrel
