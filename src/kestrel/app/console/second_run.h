// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/app/console/background_run.h"
#include "kestrel/app/console/replay_frame.h"

namespace kestrel {

// A run over a recording beside the replay.
using SecondRun = BackgroundRun<ReplayResult>;

}  // namespace kestrel
