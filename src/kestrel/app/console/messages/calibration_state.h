// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace kestrel {

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
  std::vector<std::string> requested;
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

}  // namespace kestrel
