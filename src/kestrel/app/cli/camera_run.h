// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "kestrel/app/console/camera/camera_console.h"
#include "kestrel/app/fly/fly_source.h"
#include "kestrel/app/options/kestrel_options.h"
#include "kestrel/app/web_server/console_options.h"
#include "kestrel/flight/onboard/flight_keeper.h"
#include "kestrel/flight/onboard/recording_switch.h"
#include "kestrel/io/bags/open_recording.h"

namespace kestrel {

// Choices of a camera run: the camera, the page, and where images are recorded.
struct CameraRunChoice {
  RecordingChoice camera;                   // its 'sources' has one element
  bool is_looped = false;                   // a source that has an end begins again
  std::optional<ConsoleOptions> page = {};  // nothing: none
  std::string folder = ".";                 // for calibrations that the page saves
  std::string keep_folder = ".";            // for recordings and snapshots that it asks for
  std::string record = {};  // folder of a recording that begins at once; empty: none
  bool replaces = false;    // a recording that is there
};

// A camera that needs no calibration: it is shown on the page and recorded, and nothing is measured
// with it.
class CameraRun {
 public:
  // Starts page and recording. 'source' outlives the run, which opens it where it is not open yet.
  // Throws InputError when the page cannot be served or the recording not be written.
  CameraRun(const KestrelOptions& options, CameraRunChoice choice, FlySource* source);
  ~CameraRun() { recording_.Close(); }
  CameraRun(const CameraRun&) = delete;
  CameraRun& operator=(const CameraRun&) = delete;

  // Runs until 'is_stopped', which is called often, returns true, or the source ends.
  void Play(const std::function<bool()>& is_stopped);
  // One line of how things are now; for 'is_stopped'.
  std::string State() const;

 private:
  CameraConsole::Camera Camera();
  LiveSource* Open();
  LiveSource* Wrap();

  KestrelOptions options_;
  CameraRunChoice choice_;
  FlySource* source_;
  bool has_ended_ = false;
  RecordingSwitch recording_;
  FlightKeeper keeper_;
  CameraConsole console_;
};

}  // namespace kestrel
