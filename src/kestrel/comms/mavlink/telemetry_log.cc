// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/telemetry_log.h"

#include <optional>

#include "kestrel/comms/mavlink/packet_parser.h"

namespace kestrel::mavlink {
namespace {

constexpr std::size_t kTimeSize = 8;

std::int64_t TimeIn(std::span<const std::uint8_t> record) {
  std::uint64_t time = 0;
  for (const std::uint8_t byte : record.first(kTimeSize)) time = time << 8 | byte;
  return static_cast<std::int64_t>(time);
}

// Size of the frame that begins here; 0: none does.
std::size_t FrameSize(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderSize1) return 0;
  if (bytes[0] == kMagic1) return kHeaderSize1 + bytes[1] + kChecksumSize;
  if (bytes[0] != kMagic2) return 0;
  const bool is_signed = (bytes[2] & kIncompatSigned) != 0;
  return kHeaderSize2 + bytes[1] + kChecksumSize + (is_signed ? kSignatureSize : 0);
}

// Returns the packet that these bytes are.
std::optional<Packet> PacketOf(std::span<const std::uint8_t> frame, PacketParser* parser) {
  std::optional<Packet> whole;
  const auto keep = [&](const Packet& packet) {
    if (packet.size == frame.size()) whole = packet;
  };
  parser->Parse(frame, keep);
  parser->EndDatagram(keep);
  return whole;
}

}  // namespace

std::size_t ReadTelemetryLog(
    std::span<const std::uint8_t> log,
    const std::function<void(const Packet& packet, std::int64_t utc_us)>& handler) {
  PacketParser parser;
  std::size_t skipped = 0;
  bool is_aligned = true;  // a record has ended here
  while (!log.empty()) {
    const auto rest = log.size() > kTimeSize ? log.subspan(kTimeSize) : log.first(0);
    const std::size_t size = FrameSize(rest);
    std::optional<Packet> packet;
    if (size > 0 && size <= rest.size()) packet = PacketOf(rest.first(size), &parser);
    // Only the checksum distinguishes a packet from damaged bytes.
    if (packet && (is_aligned || packet->is_known)) {
      handler(*packet, TimeIn(log));
      log = log.subspan(kTimeSize + size);
      is_aligned = true;
    } else {
      ++skipped;
      log = log.subspan(1);
      is_aligned = false;
    }
  }
  return skipped;
}

}  // namespace kestrel::mavlink
