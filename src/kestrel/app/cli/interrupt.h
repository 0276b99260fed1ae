// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace kestrel {

inline constexpr int kInterruptedStatus = 130;  // as of a program that SIGINT ends

// The end of a command that Ctrl-C has ended early. The message says what there is of its result.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// From now on the first Ctrl-C (or SIGTERM) only makes WasInterrupted() true; a second one of the
// same signal ends the program at once.
void CatchInterrupts();
bool WasInterrupted();

}  // namespace kestrel
