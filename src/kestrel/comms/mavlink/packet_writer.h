// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "kestrel/comms/mavlink/packet.h"

namespace kestrel::mavlink {

// Makes MAVLink 2 frames from messages, with a sequence of its own. Neither throws nor allocates.
class PacketWriter {
 public:
  // 'system' and 'component': ids of the sender.
  PacketWriter(std::uint8_t system, std::uint8_t component)
      : system_(system), component_(component) {}

  std::uint8_t system() const { return system_; }
  std::uint8_t component() const { return component_; }
  void set_system(std::uint8_t system) { system_ = system; }

  // Returns the frame of a message, valid until the next call. 'will_be_signed': the frame
  // announces a signature, which has to be appended (see Signing::Sign).
  template <class Message>
  std::span<std::uint8_t> Write(const Message& message, bool will_be_signed = false) {
    std::span<std::uint8_t, kMaxPayload> payload(frame_.data() + kHeaderSize2, kMaxPayload);
    return Finish(Message::kId, kLayout<Message>.crc_extra, WritePayload(message, payload),
                  will_be_signed);
  }

  // The frame's whole memory, with room for the signature.
  std::span<std::uint8_t, kMaxFrame> memory() { return frame_; }

 private:
  std::span<std::uint8_t> Finish(std::uint32_t id, std::uint8_t crc_extra, std::size_t length,
                                 bool will_be_signed) {
    const std::array<std::uint8_t, kHeaderSize2> header = {
        kMagic2,
        static_cast<std::uint8_t>(length),
        will_be_signed ? kIncompatSigned : std::uint8_t{0},
        0,
        sequence_++,
        system_,
        component_,
        static_cast<std::uint8_t>(id),
        static_cast<std::uint8_t>(id >> 8),
        static_cast<std::uint8_t>(id >> 16)};
    std::copy(header.begin(), header.end(), frame_.begin());
    const std::size_t end = kHeaderSize2 + length;
    Crc crc;
    crc.Add(std::span(frame_).subspan(1, end - 1));
    crc.Add(crc_extra);
    frame_[end] = static_cast<std::uint8_t>(crc.value());
    frame_[end + 1] = static_cast<std::uint8_t>(crc.value() >> 8);
    return {frame_.data(), end + kChecksumSize};
  }

  std::uint8_t system_;
  std::uint8_t component_;
  std::uint8_t sequence_ = 0;
  std::array<std::uint8_t, kMaxFrame> frame_{};
};

}  // namespace kestrel::mavlink
