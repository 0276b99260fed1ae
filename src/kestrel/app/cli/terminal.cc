// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/terminal.h"

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

namespace kestrel {
namespace {

// Returns a descriptor of stderr that does not block. A terminal or pipe is opened a second time,
// because the flags of the first are those of the shell too.
int OpenWithoutBlocking() {
  struct stat status {};
  const bool may_block =
      fstat(STDERR_FILENO, &status) == 0 && (S_ISCHR(status.st_mode) || S_ISFIFO(status.st_mode));
  if (!may_block) return STDERR_FILENO;
  const int own = open("/proc/self/fd/2", O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  return own >= 0 ? own : STDERR_FILENO;
}

}  // namespace

void OutliveTerminal() {
  // SIGTTOU: a program in the background that writes to its terminal would be stopped.
  for (const int number : {SIGHUP, SIGPIPE, SIGTTOU}) std::signal(number, SIG_IGN);
}

void Print(std::string_view text) {
  constexpr int kPatience_ms = 100;
  static const int file = OpenWithoutBlocking();
  static bool is_stuck = false;
  while (!text.empty()) {
    pollfd ready{file, POLLOUT, 0};
    if (poll(&ready, 1, is_stuck ? 0 : kPatience_ms) == 0) {
      is_stuck = true;
      return;
    }
    const ssize_t size = write(file, text.data(), text.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return;
    is_stuck = false;
    text.remove_prefix(static_cast<std::size_t>(size));
  }
}

}  // namespace kestrel
