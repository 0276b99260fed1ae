// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/app/console/background_run.h"
#include "kestrel/app/console/replay/replay_frame.h"

namespace kestrel {

// A second run over a recording, in the background of the replay.
using SecondRun = BackgroundRun<ReplayResult>;

}  // namespace kestrel
