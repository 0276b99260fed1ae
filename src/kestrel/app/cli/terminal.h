// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace kestrel {

// From now on neither a terminal that closes (SIGHUP) nor a pipe without a reader (SIGPIPE) ends
// the program.
void OutliveTerminal();

// Writes a text to stderr. A terminal that is gone, or that takes nothing, loses the text: it
// neither ends nor delays the program. Called by one thread at a time.
void Print(std::string_view text);

}  // namespace kestrel
