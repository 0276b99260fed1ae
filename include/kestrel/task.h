// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The task of a session: to land on a pad ("land") or to hunt for coloured objects ("hunt").
//
// Example:
//   TaskOptions options;
//   options.landing.target.kind = "apriltag";
//   const std::unique_ptr<Task> task = MakeTask("land", options);
//   const std::unique_ptr<Vision> vision =
//       task->MakeVision({.calibration = PaperCamera(), .altitude_m = 5});
//   std::cout << task->table() << ": " << vision->Found() << "\n";

#include "kestrel/flight/session/task.h"  // IWYU pragma: export
