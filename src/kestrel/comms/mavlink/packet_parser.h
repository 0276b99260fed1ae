// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "kestrel/comms/mavlink/packet.h"

namespace kestrel::mavlink {

// Finds the packets of MAVLink 1 and 2 in a stream of any bytes. After garbage, a wrong checksum,
// or an unknown incompatibility flag, it looks for the next frame from the byte after the beginning
// of the last one, so that a broken frame hides no packet. Neither throws nor allocates.
class PacketParser {
 public:
  using Handler = std::function<void(const Packet&)>;

  // Passes every packet that these bytes complete to 'handler'.
  void Parse(std::span<const std::uint8_t> bytes, const Handler& handler);

  // The datagram has ended: an incomplete frame will not be completed.
  void EndDatagram(const Handler& handler);

  std::uint64_t packets() const { return packets_; }              // found
  std::uint64_t bad_checksums() const { return bad_checksums_; }  // frames of known messages
  std::uint64_t skipped_bytes() const { return skipped_bytes_; }  // in no packet

 private:
  enum class Attempt { kPacket, kMoreBytes, kNone };
  Attempt TryFrame(std::span<const std::uint8_t> bytes);
  Attempt TryChecksum(std::span<const std::uint8_t> frame, std::uint8_t following);
  void ParseBuffered(bool is_end, const Handler& handler);
  void Drop(std::size_t count);

  static constexpr std::size_t kBuffer = 4096;
  std::array<std::uint8_t, kBuffer> buffer_{};
  std::size_t begin_ = 0;  // beginning of the data in the buffer that were not yet examined
  std::size_t end_ = 0;
  Packet packet_;
  std::uint64_t packets_ = 0;
  std::uint64_t bad_checksums_ = 0;
  std::uint64_t skipped_bytes_ = 0;
};

}  // namespace kestrel::mavlink
