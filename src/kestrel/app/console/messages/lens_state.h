// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/calibration/lens/lens_coverage.h"

namespace kestrel {

// The guided calibration of a live camera's lens.
struct ConsoleLens {
  // The lens as estimated from the views so far.
  struct Estimate {
    double focal_px = 0;
    double focal_sigma_px = 0;  // standard deviation
    double rms_px = 0;          // root mean square of the residuals
    std::size_t views = 0;      // that it is made of
    std::string model;          // distortion model
    std::vector<std::string> warnings;
  };

  bool is_running = false;
  std::string board;   // as ParseLensBoard reads it; empty: Kestrel's own print
  std::string error;   // why the calibration did not begin
  std::string advice;  // what to show next
  std::size_t views = 0;
  std::array<int, LensCoverage::kColumns * LensCoverage::kRows> fields{};  // as of LensCoverage
  int left = 0, right = 0, top = 0, bottom = 0, near = 0, far = 0;         // as of LensVariety
  std::optional<Estimate> estimate;
  std::string refusal;   // why there is no estimate although there are views
  bool is_good = false;  // good enough to be saved
  std::string folder;    // where it is saved
  std::string saved;     // path of the saved file
  std::string next;      // command that uses it
  std::string save_error;
  bool exists = false;  // the file exists, and replacing it was not requested
};

}  // namespace kestrel
