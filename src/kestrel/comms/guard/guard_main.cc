// SPDX-License-Identifier: BSD-3-Clause
// The guard: `kestrel fly` starts it with its socket as file 3. docs/guard.md.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <memory>
#include <sched.h>
#include <signal.h>
#include <span>
#include <string>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include "kestrel/comms/guard/guard_process.h"
#include "kestrel/comms/guard/guard_start.h"

namespace kestrel {
namespace {

// Signals that a terminal or systemd sends to all processes of the program are not meant for the
// guard: it ends when the program has ended.
void IgnoreSignals() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGABRT, SIGPIPE}) {
    signal(number, SIG_IGN);
  }
}

// The camera and the recording that the program has open must be free when it is gone. A terminal
// or a pipe must not wait for the guard.
void CloseOtherFiles() {
  close_range(kGuardFile + 1, ~0U, 0);
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, file);
  if (nowhere > kGuardFile) close(nowhere);
}

// As far as the system allows: before everything that is not real-time, never swapped out, and the
// last that the system kills when it has no memory.
void Prefer() {
  constexpr rlim_t kPriority = 25;
  rlimit limit{};
  getrlimit(RLIMIT_RTPRIO, &limit);
  const bool is_root = geteuid() == 0;
  sched_param parameter{};
  parameter.sched_priority =
      static_cast<int>(is_root || limit.rlim_cur > kPriority ? kPriority : limit.rlim_cur);
  if (parameter.sched_priority > 0) sched_setscheduler(0, SCHED_FIFO, &parameter);
  mlockall(MCL_CURRENT | MCL_FUTURE);
  for (const char* const adjustment : {"-1000", "-900", "-500"}) {
    const int file = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
    if (file < 0) return;
    const bool is_done = write(file, adjustment, std::strlen(adjustment)) > 0;
    close(file);
    if (is_done) return;
  }
}

int Guard(std::span<char*> arguments) {
  try {
    const auto guard = std::make_unique<GuardProcess>(
        kGuardFile, arguments[1], std::chrono::milliseconds(std::atoi(arguments[2])), arguments[3]);
    Prefer();
    return guard->Run() ? kGuardTookOver : EXIT_SUCCESS;
  } catch (const std::exception& error) {
    const std::string text = error.what();
    SendTo(kGuardFile, GuardMessage::kFailed,
           {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    return EXIT_FAILURE;
  }
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  constexpr int kArguments = 4;
  if (argc != kArguments) {
    std::fputs("kestrel-guard is started by kestrel fly --guide\n", stderr);
    return 2;
  }
  kestrel::IgnoreSignals();
  kestrel::CloseOtherFiles();
  return kestrel::Guard({argv, static_cast<std::size_t>(argc)});
}
