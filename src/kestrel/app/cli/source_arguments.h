// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>

#include "kestrel/app/cli/bag_arguments.h"
#include "kestrel/app/cli/dds_arguments.h"
#include "kestrel/app/cli/option_arguments.h"
#include "kestrel/app/cli/result_sink.h"
#include "kestrel/app/foxglove/observation_file.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

struct OpenedSource {
  std::unique_ptr<FrameSource> source;
  CameraCalibration calibration;

  // True when frames can be placed in the world, by poses and the camera's mount.
  bool has_world() const { return calibration.body_from_camera && !source->poses().empty(); }
};

// Arguments that `land` and `hunt` share: the source of the frames and the destination of the
// results. Must live until the command line is parsed.
struct SourceArguments {
  std::vector<std::string> sources;
  BagArguments bag;
  std::string camera;
  OptionArguments options;
  std::string output;
  std::string annotate;  // "video", "images" or empty
  std::string mcap;      // file; empty: none
  DdsArguments dds;
  bool still = false;
  bool force = false;
  std::optional<double> altitude_m;
  std::optional<double> clock_offset;

  void AddTo(CLI::App* command);
  // Adds the arguments for reading only, without those for the results.
  void AddReadingTo(CLI::App* command);

  // Opens the source with the calibration FILE or its own. A FILE without a mount gets the
  // source's, and its clock offset. Says on stderr when there are poses but no mount. Throws
  // InputError when there is no calibration, or when source or calibration are not valid.
  OpenedSource Open(PixelFormat format) const;

  OutputOptions Output(const OpenedSource& opened) const;

  // Opens the file of --mcap; null without. Throws InputError as ObservationFile does, and when the
  // file is the source.
  std::unique_ptr<ObservationFile> OpenMcap(const CameraIntrinsics& intrinsics,
                                            std::variant<LandingView, HuntView> view) const;

 private:
  CameraCalibration FindCalibration(const FrameSource& source) const;
};

// Throws InputError when the file to be written is one of the sources.
void RequireNoSource(const std::string& file, const std::vector<std::string>& sources);

// Adds the flag --annotate: "video" or "images".
CLI::Option* AddAnnotateFlag(CLI::App* command, std::string* annotate);

// Accepts numbers between 'min' and 'max', both excluded; 'words' describes them in the error.
// CLI11 alone would accept "nan".
CLI::Validator InRange(double min, double max, const std::string& words);

}  // namespace kestrel
