// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/guard_watch.h"

#include <utility>

#include <fmt/format.h>

#include "kestrel/comms/guard/life_of.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"

namespace kestrel {

GuardWatch::GuardWatch(GuardLink* guard, Autopilot* autopilot, const Connection* connection,
                       const GuardOptions& options, std::function<void(const std::string&)> report)
    : guard_(guard),
      autopilot_(autopilot),
      connection_(connection),
      options_(options),
      report_(std::move(report)) {}

bool GuardWatch::Watch(Time now, GuardTask task) {
  guard_->SendLife(LifeOf(task, *autopilot_, *connection_), now);
  const GuardState state = guard_->state();
  if (state == reported_) return true;
  reported_ = state;
  switch (state) {
    case GuardState::kWaits:
      report_("the guard of an earlier flight still has the line: waiting for it");
      return true;
    case GuardState::kWatches:
      report_("the line is free");
      return true;
    case GuardState::kGone:
      ReportGone();
      return true;
    case GuardState::kTookOver:
      reason_ =
          fmt::format("the guard has stopped the UAV: Kestrel gave no sign of life for {:g} s",
                      options_.silence_s);
      return false;
    case GuardState::kFailed:
      reason_ = guard_->error();
      return false;
  }
  return true;
}

// Guidance goes on: to end it here would leave the UAV to itself for certain.
void GuardWatch::ReportGone() {
  report_(fmt::format("the guard is gone ({}): the flight goes on without it", guard_->error()));
  autopilot_->Announce(mavlink::kSeverityError, "Kestrel: the guard is gone, flying on without");
}

}  // namespace kestrel
