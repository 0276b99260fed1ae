// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/app/cli/task_argument.h"
#include "kestrel/app/cli/team_arguments.h"
#include "kestrel/app/options/kestrel_options.h"
#include "kestrel/comms/mavlink/global_position.h"
#include "kestrel/flight/guidance/go_job.h"
#include "kestrel/flight/guidance/relative_guidance.h"

namespace kestrel {

// Arguments that `fly` and `doctor` share. Must live until the command line is parsed.
struct FlyArguments {
  SourceArguments source;
  std::string autopilot;  // URL, or "sim:ardupilot", "sim:px4"; empty: none
  std::string profile = "auto";
  std::optional<double> rate_hz;
  std::string link_delay = "auto";
  std::string signing_key;
  std::string record;
  std::optional<std::string> console;  // ADDRESS:PORT; empty: as in the options
  std::string video;                   // rtsp://ADDRESS:PORT/PATH; empty: none
  bool guide = false;
  bool point = false;
  bool pad_position = false;
  bool no_position = false;
  bool hover = false;
  std::string floor, ceiling;  // a person's answers; empty: none was given
  bool no_guard = false;
  TaskArgument task;
  std::string model;  // file with the model of the objects
  // Class of the objects to one of which the UAV goes, "marked", or LAT,LON; empty: it goes
  // nowhere.
  std::string go;
  std::string then = "hover";           // its job there, as ParseGoJob reads it
  GoJob job;                            // the same, and what the UAV goes to; by ReadOptions
  std::optional<GlobalPosition> place;  // of a job at a place; by ReadOptions
  std::string box;                      // LAT,LON where it takes the objects; empty: it keeps one
  std::optional<GlobalPosition> box_place;  // the same; by ReadOptions
  TeamArguments team;
  bool loop = false;
  // Options that the command line sets over the configuration file, as "key=value"; by ReadOptions.
  std::vector<std::string> given;

  void AddTo(CLI::App* command);

  // The cameras, of which there are several, with their calibrations.
  std::vector<RecordingChoice> Cameras(PixelFormat format) const;

  // The job of a flight without a position; nothing: it has one. After ReadOptions.
  std::optional<RelativeJob> WithoutPosition() const;

  // Returns the options with the changes that these arguments make; a source that the command line
  // does not name becomes that of the options. Throws InputError for arguments of `land` that a
  // flight does not support, and when the options are not valid. Once only.
  KestrelOptions ReadOptions();

 private:
  void ReadGo(const FlyOptions& options);
};

}  // namespace kestrel
