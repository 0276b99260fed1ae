// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/comms/mavlink/stream_transport.h"

namespace kestrel {

// serial:// and serial_flowcontrol://: eight bits, no parity, one stop bit. The device is locked
// against other programs that respect locks.
class SerialTransport : public StreamTransport {
 public:
  explicit SerialTransport(const LinkUrl& url);

 protected:
  Line Open() override;
  ssize_t Write(int file, std::span<const std::uint8_t> bytes) override;

 private:
  LinkUrl url_;
};

}  // namespace kestrel
