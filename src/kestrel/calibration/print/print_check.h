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
  kTooCoarse,  // the photograph does not tell
};
const char* ToString(PrintVerdict verdict);  // "good", "WRONG", "cannot tell"

// A dimension of the pattern, by the name of its option, and what was measured of it.
struct CheckedDimension {
  std::string option;
  double configured_m;
  std::optional<MeasuredLength>
      measured;  // nothing: the arms reach the ring, as far as can be seen
  PrintVerdict verdict;

  double tolerance_m() const { return measured ? 3 * measured->sigma_m : 0; }
};

// How large a print is to what is configured, with its standard deviation.
struct PrintScale {
  double value;
  double sigma;
};
// By the camera's distance from the middle of the pattern, measured to a hundredth, and by the
// ruler on the print, measured to a fifth of a millimetre.
PrintScale ScaleByDistance(double distance_m, const PrintMeasurement& print);
PrintScale ScaleByRuler(double ruler_m, const LandingPattern& configured);

// Holds a measured print against the configuration. Without a scale only the proportions: the outer
// diameter is then taken for right and is not among the results.
std::vector<CheckedDimension> CheckPrint(const LandingPattern& configured,
                                         const PrintMeasurement& print,
                                         const std::optional<PrintScale>& scale);

}  // namespace kestrel
