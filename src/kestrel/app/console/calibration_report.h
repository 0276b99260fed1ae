// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/calibration/lens/lens_calibration.h"
#include "kestrel/calibration/mount/flight_calibration.h"
#include "kestrel/calibration/mount/flight_sightings.h"
#include "kestrel/core/camera/calibration.h"

namespace kestrel {

// The calibration that the page asks for: either the lens, or mount, clock or both.
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

// An estimated quantity. Unknown values are NaN.
struct CalibrationNumber {
  std::string name;
  std::string unit;
  double before = 0;
  double after = 0;
  double sigma = 0;  // standard deviation
};

// Residuals before and after the calibration.
struct CalibrationResiduals {
  std::string of;    // measured quantity, as "position in the world"
  std::string unit;  // as "m"
  std::string over;  // label of the abscissa, as "time, s"
  double rms_before = 0;
  double rms_after = 0;
  std::vector<std::array<double, 3>> points;  // abscissa, before, after
};

// Progress and result of a calibration.
enum class CalibrationState { kNone, kRunning, kDone, kCancelled, kRefused };
struct ConsoleCalibration {
  CalibrationState state = CalibrationState::kNone;
  std::size_t number = 0;  // number of the calibration, from 1
  std::vector<std::string> asked;
  std::size_t done = 0;  // images done
  std::size_t of = 0;
  bool is_ending = false;  // it was cancelled during a step that takes a while
  std::string error;       // why it was refused
  cv::Size image;          // px
  // Places in the image of the pattern, or of its edges, and distances of the camera from it (m).
  std::vector<cv::Point2f> places;
  std::string distance_name;
  std::vector<double> distances_m;
  std::string coverage;  // in words
  std::vector<CalibrationNumber> numbers;
  CalibrationResiduals residuals;
  std::vector<std::string> warnings;
  bool can_save = false;   // the user gave a folder
  std::string no_use;      // why the result is not worth keeping; else empty
  std::string saved;       // path of the saved file
  std::string save_error;  // why it was not saved
};

// Returns the part of the report that says what a flight covers. 'images': in the whole flight.
ConsoleCalibration FlightCoverage(const std::vector<PatternPlace>& places, std::size_t images,
                                  const cv::Size& image);

// Adds mount and clock to the report of a flight. 'given': the initial mount and clock.
void AddFlight(const FlightCalibration& result, const FlightCalibrationOptions& options,
               const MountAndClock& given, ConsoleCalibration* report);

// Returns the report on a lens. 'given': intrinsics of the recording, compared on the same views.
ConsoleCalibration LensReport(const LensCalibration& lens, const CameraIntrinsics& given,
                              std::size_t images);

}  // namespace kestrel
