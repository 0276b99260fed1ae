// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "kestrel/comms/mavlink/message_layout.h"

namespace kestrel::mavlink {

inline constexpr std::uint8_t kMagic1 = 0xfe;  // first byte of a frame of MAVLink 1
inline constexpr std::uint8_t kMagic2 = 0xfd;  // first byte of a frame of MAVLink 2
inline constexpr std::size_t kHeaderSize1 = 6;
inline constexpr std::size_t kHeaderSize2 = 10;
inline constexpr std::size_t kChecksumSize = 2;
inline constexpr std::size_t kSignatureSize = 13;
inline constexpr std::size_t kMaxFrame =
    kHeaderSize2 + kMaxPayload + kChecksumSize + kSignatureSize;
inline constexpr std::uint8_t kIncompatSigned = 0x01;  // the only incompatibility flag that exists

// A message as received.
struct Packet {
  std::uint8_t system = 0;  // system id of the sender
  std::uint8_t component = 0;
  std::uint8_t sequence = 0;
  std::uint32_t id = 0;
  bool is_known = false;   // in messages.h: the checksum of others cannot be verified
  bool is_signed = false;  // carries a signature; Signing decides whether it is valid
  std::array<std::uint8_t, kMaxFrame> bytes{};
  std::size_t size = 0;  // bytes of the frame, from the magic byte to checksum or signature
  std::size_t header_size = 0;
  std::size_t payload_size = 0;

  std::span<const std::uint8_t> frame() const { return {bytes.data(), size}; }
  std::span<const std::uint8_t> payload() const {
    return {bytes.data() + header_size, payload_size};
  }

  // Returns the message, if it is of this type.
  template <class Message>
  std::optional<Message> As() const {
    if (id != Message::kId) return std::nullopt;
    return ReadPayload<Message>(payload());
  }
};

}  // namespace kestrel::mavlink
