// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace kestrel {

// First byte of the records of an MCAP file (mcap.dev/spec).
inline constexpr std::uint8_t kMcapHeader = 0x01;
inline constexpr std::uint8_t kMcapFooter = 0x02;
inline constexpr std::uint8_t kMcapSchema = 0x03;
inline constexpr std::uint8_t kMcapChannel = 0x04;
inline constexpr std::uint8_t kMcapMessage = 0x05;
inline constexpr std::uint8_t kMcapChunk = 0x06;
inline constexpr std::uint8_t kMcapMessageIndex = 0x07;
inline constexpr std::uint8_t kMcapChunkIndex = 0x08;
inline constexpr std::uint8_t kMcapStatistics = 0x0b;
inline constexpr std::uint8_t kMcapDataEnd = 0x0f;

}  // namespace kestrel
