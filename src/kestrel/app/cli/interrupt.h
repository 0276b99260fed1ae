// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace kestrel {

// From now on the first Ctrl-C (or SIGTERM) only makes WasInterrupted() true; a second one of the
// same signal ends the program at once.
void CatchInterrupts();
bool WasInterrupted();

}  // namespace kestrel
