// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/app/cli/console_arguments.h"

namespace kestrel {

// True when the only source is a folder with the results of `kestrel study run`.
bool IsStudy(const ConsoleArguments& arguments);

// Serves the page of a study until Ctrl-C: its table, and the replay of any of its recordings. The
// arguments for reading and the options hold for all recordings, over those of the study's plan.
// Throws InputError when results or plan cannot be read.
void RunStudyConsole(const ConsoleArguments& arguments);

}  // namespace kestrel
