// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "kestrel/comms/mavlink/packet_writer.h"

namespace kestrel {

// Makes the bytes of a .tlog.
class TestTelemetryLog {
 public:
  // 'component': that sends it; 1 is the autopilot.
  template <class Message>
  void Add(std::int64_t utc_us, const Message& message, std::uint8_t component = 1) {
    for (int shift = 56; shift >= 0; shift -= 8) {
      bytes_ += static_cast<char>(static_cast<std::uint64_t>(utc_us) >> shift);
    }
    mavlink::PacketWriter writer(1, component);
    for (const std::uint8_t byte : writer.Write(message)) bytes_ += static_cast<char>(byte);
  }

  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
};

}  // namespace kestrel
