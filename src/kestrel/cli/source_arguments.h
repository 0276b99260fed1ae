// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "kestrel/base/time.h"
#include "kestrel/camera/calibration.h"
#include "kestrel/cli/option_arguments.h"
#include "kestrel/recording/frame_source.h"

namespace kestrel {

// The arguments that `land` and `hunt` share: where the frames come from and where the results go.
// Must live until the command line is parsed.
struct SourceArguments {
  std::vector<std::string> sources;
  std::string camera;
  OptionArguments options;
  std::string output;
  std::string annotate;  // "video", "images" or empty
  bool still = false;
  bool force = false;
  std::optional<double> altitude_m;
  std::optional<double> clock_offset;

  void AddTo(CLI::App* command);

  // The calibration FILE or the source's own; a FILE without a mount takes the source's, and its
  // clock offset. Says on stderr when there are poses but no mount. Throws InputError when there is
  // no calibration or it is at fault.
  CameraCalibration FindCalibration(const FrameSource& source) const;
};

// The flag --annotate: "video" or "images".
CLI::Option* AddAnnotateFlag(CLI::App* command, std::string* annotate);

// Accepts numbers above 'min' and below 'max', which 'words' names; CLI11 takes "nan" for one.
CLI::Validator InRange(double min, double max, const std::string& words);

// Throws InputError when the frame is not of the calibration's size.
void RequireSize(const Frame& frame, const CameraIntrinsics& intrinsics);

// Times of Detect, for the line at the end of a run.
class DetectTimes {
 public:
  void Add(Duration time) { ms_.push_back(1e3 * ToSeconds(time)); }
  std::size_t frames() const { return ms_.size(); }
  // ", detect_ms median 0.24, p99 0.51"; empty without a frame.
  std::string Summary() const;

 private:
  std::vector<double> ms_;
};

}  // namespace kestrel
