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
#include "kestrel/core/camera/calibration.h"

namespace kestrel {

// What the page asks for: the lens, or mount, clock or both of them.
struct CalibrationRequest {
  bool mount = false;
  bool clock = false;
  bool moving = false;  // the pattern moves, for mount and clock
  bool lens = false;

  // Of the file that it is saved in: "mount", "clock", "mount_clock", "lens".
  std::string Name() const;
};

// The words of a request: "lens", or "mount" and "clock" with or without "moving". Throws
// InputError for anything else.
CalibrationRequest ParseCalibrationRequest(const std::vector<std::string>& words);

// A quantity that was estimated; what is not known is NaN.
struct CalibrationNumber {
  std::string name;
  std::string unit;
  double before = 0;
  double after = 0;
  double sigma = 0;  // standard deviation
};

// What is left of what was seen, before and after.
struct CalibrationResiduals {
  std::string of;    // as "position in the world"
  std::string unit;  // as "m"
  std::string over;  // what they are drawn over, as "time, s"
  double rms_before = 0;
  double rms_after = 0;
  std::vector<std::array<double, 3>> points;  // over, before, after
};

// How far a calibration is, and what it came to.
enum class CalibrationState { kNone, kRunning, kDone, kCancelled, kRefused };
struct ConsoleCalibration {
  CalibrationState state = CalibrationState::kNone;
  std::size_t number = 0;  // of the calibration, from 1
  std::vector<std::string> asked;
  std::size_t done = 0;  // images, of all
  std::size_t of = 0;
  bool is_ending = false;  // it was cancelled while something went on that takes a while
  std::string error;       // why it was refused
  cv::Size image;          // px
  // Where in the image the pattern, or its edges, were; and how far the camera was from it (m).
  std::vector<cv::Point2f> places;
  std::string distance_name;
  std::vector<double> distances_m;
  std::string coverage;  // in words
  std::vector<CalibrationNumber> numbers;
  CalibrationResiduals residuals;
  std::vector<std::string> warnings;
  bool can_save = false;   // the user gave a folder
  std::string saved;       // the file
  std::string save_error;  // why it was not
};

// Where the pattern was in one image of a flight.
struct PatternPlace {
  cv::Point2f pixel;  // of its centre
  double height_m;    // of the camera above it
};

// The part of the report that says what a flight covers. 'images': in all of the flight.
ConsoleCalibration FlightCoverage(const std::vector<PatternPlace>& places, std::size_t images,
                                  const cv::Size& image);

// Puts mount and clock into the report of a flight. 'given': what it began with.
void AddFlight(const FlightCalibration& result, const FlightCalibrationOptions& options,
               const MountAndClock& given, ConsoleCalibration* report);

// The report on a lens. 'given': what the recording has; it is compared on the same views.
ConsoleCalibration LensReport(const LensCalibration& lens, const CameraIntrinsics& given,
                              std::size_t images);

}  // namespace kestrel
