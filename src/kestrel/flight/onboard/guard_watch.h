// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "kestrel/comms/guard/guard_link.h"
#include "kestrel/comms/guard/guard_options.h"
#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// Gives the guard its signs of life, and informs the user and the ground station what becomes of
// it. Used by the link's thread only.
class GuardWatch {
 public:
  // All that pointers name outlives this. 'report': receives lines for the user.
  GuardWatch(GuardLink* guard, Autopilot* autopilot, const Connection* connection,
             const GuardOptions& options, std::function<void(const std::string&)> report);

  // Called after each set-point that was due. 'task': if this is the last sign of life. False: the
  // guard has the UAV, or the line cannot be opened, and the flight has to end.
  bool Watch(Time now, GuardTask task);

  // Why the flight has to end; empty: it goes on.
  const std::string& reason() const { return reason_; }

 private:
  void ReportGone();

  GuardLink* guard_;
  Autopilot* autopilot_;
  const Connection* connection_;
  GuardOptions options_;
  std::function<void(const std::string&)> report_;
  std::string reason_;
  GuardState reported_ = GuardState::kWatches;
};

}  // namespace kestrel
