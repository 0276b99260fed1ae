// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace kestrel::mavlink {

// MAVLink's checksum: CRC-16/MCRF4XX, which its documents call X.25.
class Crc {
 public:
  constexpr void Add(std::uint8_t byte) {
    std::uint8_t mixed = byte ^ static_cast<std::uint8_t>(value_ & 0xff);
    mixed ^= static_cast<std::uint8_t>(mixed << 4);
    value_ = static_cast<std::uint16_t>((value_ >> 8) ^ (mixed << 8) ^ (mixed << 3) ^ (mixed >> 4));
  }
  constexpr void Add(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) Add(byte);
  }
  constexpr void Add(std::string_view text) {
    for (const char character : text) Add(static_cast<std::uint8_t>(character));
  }
  constexpr std::uint16_t value() const { return value_; }

 private:
  std::uint16_t value_ = 0xffff;
};

}  // namespace kestrel::mavlink
