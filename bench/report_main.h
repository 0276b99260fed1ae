// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {

// Returns the exit status of a report: that of 'run', or 1 with a line on stderr for an InputError.
template <class Run>
int ReportMain(const Run& run) {
  try {
    return run();
  } catch (const InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}

}  // namespace kestrel
