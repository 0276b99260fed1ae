// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kestrel/calibration/print/print_measurement.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

enum class PrintVerdict {
  kGood,
  kWrong,
  kTooCoarse,  // the photograph is not accurate enough
};
const char* ToString(PrintVerdict verdict);  // "good", "WRONG", "cannot tell"

// A dimension of the pattern, with the name of its option, and its measurement.
struct CheckedDimension {
  std::string option;
  double configured_m;
  std::optional<MeasuredLength>
      measured;  // nothing: the arms reach the ring, as far as can be seen
  PrintVerdict verdict;

  double tolerance_m() const { return measured ? 3 * measured->sigma_m : 0; }
};

// Size of a print relative to the configuration, with its standard deviation.
struct PrintScale {
  double value;
  double sigma;
};
// Return the scale from the camera's distance to the middle of the pattern, measured to 1 %, and
// from the ruler on the print, measured to a fifth of a millimetre.
PrintScale ScaleByDistance(double distance_m, const PrintMeasurement& print);
PrintScale ScaleByRuler(double ruler_m, const LandingPattern& configured);

// Compares a measured print with the configuration. Without a scale it checks the proportions only:
// the outer diameter is then assumed to be right and is not among the results.
std::vector<CheckedDimension> CheckPrint(const LandingPattern& configured,
                                         const PrintMeasurement& print,
                                         const std::optional<PrintScale>& scale);

// Returns a table of the dimensions for people, a line each, in mm.
std::string DimensionsTable(const std::vector<CheckedDimension>& dimensions);

// Throws InputError when a dimension is not as configured or cannot be measured. The message names
// it and the settings that describe the print. 'photo': name of the photograph.
void RequireAsConfigured(const std::string& photo, const std::vector<CheckedDimension>& dimensions);

}  // namespace kestrel
