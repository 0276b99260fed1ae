// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/packet_parser.h"

#include <algorithm>
#include <cstring>

#include "kestrel/comms/mavlink/message_table.h"

namespace kestrel::mavlink {
namespace {

bool IsMagic(std::uint8_t byte) { return byte == kMagic1 || byte == kMagic2; }

void ReadHeader1(std::span<const std::uint8_t> bytes, Packet* packet) {
  packet->sequence = bytes[2];
  packet->system = bytes[3];
  packet->component = bytes[4];
  packet->id = bytes[5];
  packet->is_signed = false;
  packet->header_size = kHeaderSize1;
}

void ReadHeader2(std::span<const std::uint8_t> bytes, Packet* packet) {
  packet->sequence = bytes[4];
  packet->system = bytes[5];
  packet->component = bytes[6];
  packet->id = bytes[7] | bytes[8] << 8 | bytes[9] << 16;
  packet->is_signed = (bytes[2] & kIncompatSigned) != 0;
  packet->header_size = kHeaderSize2;
}

}  // namespace

void PacketParser::Parse(std::span<const std::uint8_t> bytes, const Handler& handler) {
  while (!bytes.empty()) {
    if (begin_ > 0) {
      std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
      end_ -= begin_;
      begin_ = 0;
    }
    const std::size_t count = std::min(bytes.size(), kBuffer - end_);
    std::memcpy(buffer_.data() + end_, bytes.data(), count);
    end_ += count;
    bytes = bytes.subspan(count);
    ParseBuffered(false, handler);
  }
}

void PacketParser::EndDatagram(const Handler& handler) { ParseBuffered(true, handler); }

// The rest in the buffer is less than a frame: there is room for the next bytes.
void PacketParser::ParseBuffered(bool is_end, const Handler& handler) {
  while (begin_ < end_) {
    const Attempt attempt = TryFrame({buffer_.data() + begin_, end_ - begin_});
    if (attempt == Attempt::kMoreBytes && !is_end) return;
    if (attempt == Attempt::kPacket) {
      begin_ += packet_.size;
      ++packets_;
      handler(packet_);
    } else {
      Drop(1);
    }
  }
}

void PacketParser::Drop(std::size_t count) {
  begin_ += count;
  skipped_bytes_ += count;
}

// Parses the frame that begins with the first of these bytes into packet_.
PacketParser::Attempt PacketParser::TryFrame(std::span<const std::uint8_t> bytes) {
  if (!IsMagic(bytes[0])) return Attempt::kNone;
  const bool is_version_2 = bytes[0] == kMagic2;
  if (bytes.size() < (is_version_2 ? kHeaderSize2 : kHeaderSize1)) return Attempt::kMoreBytes;
  if (is_version_2) {
    if ((bytes[2] & ~kIncompatSigned) != 0) return Attempt::kNone;
    ReadHeader2(bytes, &packet_);
  } else {
    ReadHeader1(bytes, &packet_);
  }
  packet_.payload_size = bytes[1];
  packet_.size = packet_.header_size + packet_.payload_size + kChecksumSize +
                 (packet_.is_signed ? kSignatureSize : 0);
  if (bytes.size() < packet_.size) return Attempt::kMoreBytes;
  const Attempt attempt = TryChecksum(bytes.first(packet_.size),
                                      bytes.size() > packet_.size ? bytes[packet_.size] : kMagic2);
  if (attempt == Attempt::kPacket) std::memcpy(packet_.bytes.data(), bytes.data(), packet_.size);
  return attempt;
}

// The checksum of an unknown message cannot be verified: the frame is accepted if another frame, or
// nothing yet, follows it.
PacketParser::Attempt PacketParser::TryChecksum(std::span<const std::uint8_t> frame,
                                                std::uint8_t following) {
  const MessageInfo* info = FindMessage(packet_.id);
  packet_.is_known = info != nullptr;
  if (!packet_.is_known) {
    return IsMagic(following) ? Attempt::kPacket : Attempt::kNone;
  }
  const std::size_t end = packet_.header_size + packet_.payload_size;
  Crc crc;
  crc.Add(frame.subspan(1, end - 1));
  crc.Add(info->layout->crc_extra);
  if (crc.value() == (frame[end] | frame[end + 1] << 8)) return Attempt::kPacket;
  ++bad_checksums_;
  return Attempt::kNone;
}

}  // namespace kestrel::mavlink
