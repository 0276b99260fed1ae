// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/interrupt.h"

#include <csignal>

namespace kestrel {
namespace {

volatile std::sig_atomic_t was_interrupted = 0;

void OnInterrupt(int signal) {
  was_interrupted = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void CatchInterrupts() {
  std::signal(SIGINT, OnInterrupt);
  std::signal(SIGTERM, OnInterrupt);
}

bool WasInterrupted() { return was_interrupted != 0; }

}  // namespace kestrel
