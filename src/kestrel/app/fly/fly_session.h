// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/app/fly/fly_autopilot.h"
#include "kestrel/app/fly/fly_source.h"
#include "kestrel/app/options/kestrel_options.h"
#include "kestrel/flight/onboard/live_session.h"
#include "kestrel/flight/onboard/live_session_options.h"

namespace kestrel {

// The options of a session with this source and this autopilot.
LiveSessionOptions SessionOptions(const KestrelOptions& options, const FlySource& source,
                                  const FlyAutopilot& autopilot);

// The parts of a session that source and autopilot are. Both must outlive it.
LiveSessionParts SessionParts(FlySource* source, const FlyAutopilot& autopilot);

}  // namespace kestrel
