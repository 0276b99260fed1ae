// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/app/cli/console_arguments.h"

namespace kestrel {

// True when the source is a camera: a device, a pipeline, or a source of "sim:" or "dds:".
bool IsLiveSource(const std::string& source);

// Shows a camera on the page until Ctrl-C, with or without a calibration. Throws InputError when
// the page cannot be served, or an argument is not valid.
void RunCameraConsole(const ConsoleArguments& arguments);

}  // namespace kestrel
