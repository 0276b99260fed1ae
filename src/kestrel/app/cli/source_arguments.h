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

  // Whether frames can be placed in the world: by poses and the camera's mount.
  bool has_world() const { return calibration.body_from_camera && !source->poses().empty(); }
};

// The arguments that `land` and `hunt` share: where the frames come from and where the results go.
// Must live until the command line is parsed.
struct SourceArguments {
  std::vector<std::string> sources;
  BagArguments bag;
  std::string camera;
  OptionArguments options;
  std::string output;
  std::string annotate;  // "video", "images" or empty
  std::string mcap;      // file, or empty
  DdsArguments dds;
  bool still = false;
  bool force = false;
  std::optional<double> altitude_m;
  std::optional<double> clock_offset;

  void AddTo(CLI::App* command);
  // Without where results go.
  void AddReadingTo(CLI::App* command);

  // The source with the calibration FILE or its own; a FILE without a mount takes the source's, and
  // its clock offset. Says on stderr when there are poses but no mount. Throws InputError when
  // there is no calibration, or source or calibration are at fault.
  OpenedSource Open(PixelFormat format) const;

  OutputOptions Output(const OpenedSource& opened) const;

  // The file of --mcap; null without. Throws InputError as ObservationFile does, and when it is
  // the source.
  std::unique_ptr<ObservationFile> OpenMcap(const CameraIntrinsics& intrinsics,
                                            std::variant<LandingView, HuntView> view) const;

 private:
  CameraCalibration FindCalibration(const FrameSource& source) const;
};

// Throws InputError when the file that is to be written is one of the sources.
void RequireNoSource(const std::string& file, const std::vector<std::string>& sources);

// The flag --annotate: "video" or "images".
CLI::Option* AddAnnotateFlag(CLI::App* command, std::string* annotate);

// Accepts numbers above 'min' and below 'max', which 'words' names; CLI11 takes "nan" for one.
CLI::Validator InRange(double min, double max, const std::string& words);

}  // namespace kestrel
