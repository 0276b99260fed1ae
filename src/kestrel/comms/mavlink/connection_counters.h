// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace kestrel {

// Counts of a connection since it was made.
struct ConnectionCounters {
  std::uint64_t received = 0;          // packets that were passed on
  std::uint64_t sent = 0;              // packets that the system accepted
  std::uint64_t unsent = 0;            // packets that it did not accept: line full, or nobody there
  std::uint64_t bad_checksums = 0;     // damaged frames
  std::uint64_t garbage_bytes = 0;     // bytes that belong to no packet
  std::uint64_t unsigned_packets = 0;  // refused by a signed connection, like the next two
  std::uint64_t forged_packets = 0;
  std::uint64_t replayed_packets = 0;
};

}  // namespace kestrel
