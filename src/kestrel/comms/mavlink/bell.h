// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <sys/eventfd.h>
#include <unistd.h>

#include "kestrel/comms/mavlink/file_descriptor.h"

namespace kestrel {

// Ends the wait of another thread that waits for files. Any thread may ring; it never waits.
class Bell {
 public:
  int file() const { return file_.number(); }  // readable once it has rung

  void Ring() {
    const std::uint64_t one = 1;
    // Fails only when it has rung often already.
    [[maybe_unused]] const auto written = write(file(), &one, sizeof(one));
  }
  // It is silent again.
  void Silence() {
    std::uint64_t rung = 0;
    [[maybe_unused]] const auto size = read(file(), &rung, sizeof(rung));
  }

 private:
  FileDescriptor file_{eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};
};

}  // namespace kestrel
