// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "kestrel/app/console/background_run.h"
#include "kestrel/app/console/calibration_report.h"
#include "kestrel/app/console/console_feed.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

struct CalibrationResult {
  ConsoleCalibration report;  // refused: without a calibration
  CameraCalibration calibration;
  double rate_hz = 0;  // of the images
};

// The page that calibrates from a recording beside its replay. All functions by the thread that
// plays it, which never waits for a calibration.
class CalibrationPage {
 public:
  using Run = BackgroundRun<CalibrationResult>;
  struct Tools {
    // By a thread of its own; nothing when it was to end. Throws InputError when it is refused.
    std::function<std::optional<CalibrationResult>(const CalibrationRequest& request,
                                                   const Run::GoOn& go_on)>
        calibrate;
    // Writes what was found to a new file of a like name, whose path it returns. Throws InputError.
    // Empty: the user gave no folder.
    std::function<std::string(const std::string& name, const CalibrationResult& result)> save;
  };

  // 'frames': of the recording. 'feed' outlives the page.
  CalibrationPage(Tools tools, std::size_t frames, ConsoleFeed* feed);

  // What concerns a calibration; while one goes on no other is begun.
  void Obey(const ConsoleCommand& command);
  // To be called often: tells how far it is.
  void Follow();
  // The file of what was found; without content when there is none of this number.
  ExportAnswer File(std::size_t number) const;

 private:
  void Start(const std::vector<std::string>& words);
  void End(Run::Outcome outcome);
  void Save();
  void Refuse(const std::string& error);
  void Tell();

  Tools tools_;
  std::size_t frames_;
  ConsoleFeed* feed_;
  Time told_{};
  ConsoleCalibration report_;
  CalibrationRequest request_;
  std::optional<CalibrationResult> result_;  // of report_.number
  Run run_;
};

}  // namespace kestrel
