// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "kestrel/app/console/background_run.h"
#include "kestrel/app/console/calibration/calibration_report.h"
#include "kestrel/app/console/messages/console_feed.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

struct CalibrationResult {
  ConsoleCalibration report;  // without a calibration when it is refused
  CameraCalibration calibration;
  double rate_hz = 0;  // frame rate of the images
};

// The part of the page that calibrates from a recording during its replay. All functions are called
// by the thread that plays the recording; it never waits for a calibration.
class CalibrationPage {
 public:
  using Run = BackgroundRun<CalibrationResult>;
  struct Tools {
    // Called by a thread of its own. Returns nothing if it was cancelled. Throws InputError when
    // the calibration is refused.
    std::function<std::optional<CalibrationResult>(const CalibrationRequest& request,
                                                   const Run::GoOn& go_on)>
        calibrate;
    // Writes the result to a new file with a similar name and returns its path. Throws InputError.
    // Empty when the user gave no folder.
    std::function<std::string(const std::string& name, const CalibrationResult& result)> save;
  };

  // 'frames': number of frames of the recording. 'feed' outlives the page.
  CalibrationPage(Tools tools, std::size_t frames, ConsoleFeed* feed);

  // Executes a command that concerns calibrations. Only one calibration runs at a time.
  void Obey(const ConsoleCommand& command);
  // Reports the progress and takes the result. Call it often.
  void Follow();
  // Returns the file of the calibration with this number; an empty answer when there is none.
  ExportAnswer File(std::size_t number) const;

 private:
  void Start(const std::vector<std::string>& words);
  void End(Run::Outcome outcome);
  void Save();
  void Refuse(const std::string& error);
  void Notify();

  Tools tools_;
  std::size_t frames_;
  ConsoleFeed* feed_;
  Time reported_{};
  ConsoleCalibration report_;
  CalibrationRequest request_;
  std::optional<CalibrationResult> result_;  // result of calibration report_.number
  Run run_;
};

}  // namespace kestrel
