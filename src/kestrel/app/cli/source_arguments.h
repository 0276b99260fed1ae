// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "kestrel/app/cli/bag_arguments.h"
#include "kestrel/app/cli/dds_arguments.h"
#include "kestrel/app/cli/option_arguments.h"
#include "kestrel/flight/onboard/session.h"
#include "kestrel/io/bags/open_recording.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// Arguments that `land` and `hunt` share: the source of the frames and the destination of the
// results. Must live until the command line is parsed.
struct SourceArguments {
  std::vector<std::string> sources;
  BagArguments bag;
  std::vector<std::string> cameras;  // files with the calibration; empty: the source's own
  OptionArguments options;
  std::string output;
  std::string annotate;  // "video", "images" or empty
  std::string mcap;      // file; empty: none
  DdsArguments dds;
  bool still = false;
  bool force = false;
  std::optional<double> altitude_m;
  std::optional<double> clock_offset;
  std::optional<double> fov_deg;

  void AddTo(CLI::App* command);
  // Adds the arguments for reading only, without those for the results.
  void AddReadingTo(CLI::App* command);

  // The file with the calibration; empty: the source's own. Throws InputError when there are
  // several.
  std::string camera() const;

  // The recording and what the arguments say of it. Warnings go to stderr.
  RecordingChoice Recording(PixelFormat format) const;

  // Opens the recording. Without a calibration, and without an output that needs one, a lens is
  // assumed.
  OpenedSource OpenOrAssume(PixelFormat format, bool all_cameras = false) const;

  // The options of a session over the recording.
  SessionOptions Session() const;
};

// Returns the objects of a file; those that are built in where it has no name.
ObjectModel ReadModel(const std::string& file);

// Throws InputError when the file to be written is one of the sources.
void RequireNoSource(const std::string& file, const std::vector<std::string>& sources);

// Adds the flag --annotate: "video" or "images".
CLI::Option* AddAnnotateFlag(CLI::App* command, std::string* annotate);

// Accepts numbers between 'min' and 'max', both excluded; 'words' describes them in the error.
// CLI11 alone would accept "nan".
CLI::Validator InRange(double min, double max, const std::string& words);

}  // namespace kestrel
