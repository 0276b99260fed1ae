// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "kestrel/comms/mavlink/packet.h"

namespace kestrel::mavlink {

// Passes the packets of a .tlog to 'handler' in their order: a sequence of times (us of UTC, big
// endian) and packets. Goes on with the next whole packet after what is damaged. Returns the number
// of bytes that belong to no packet.
std::size_t ReadTelemetryLog(
    std::span<const std::uint8_t> log,
    const std::function<void(const Packet& packet, std::int64_t utc_us)>& handler);

}  // namespace kestrel::mavlink
