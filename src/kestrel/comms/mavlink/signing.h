// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "kestrel/comms/mavlink/packet.h"

namespace kestrel::mavlink {

using SigningKey = std::array<std::uint8_t, 32>;

// Reads the key from a file: 32 bytes, or 64 hexadecimal digits. Throws InputError when the file
// does not exist, when others than its owner may read or write it, or when it holds no key; a key
// of zeros is not valid, because it means "do not sign" to autopilots.
SigningKey ReadSigningKey(const std::string& path);

// The computer's clock, ns since 1970.
std::uint64_t UnixNanoseconds();

// Signs packets and verifies those of others, as in mavlink.io/en/guide/message_signing. A signed
// packet carries a timestamp that only increases, which prevents replay. Neither throws nor
// allocates after construction; not thread-safe.
class Signing {
 public:
  // Ticks of 10 us since 2015.
  using Timestamp = std::uint64_t;
  static Timestamp TimestampOf(std::uint64_t unix_ns);

  // 'stored': last timestamp of the previous run. New timestamps are later, even if the computer's
  // clock does not run while it is off.
  Signing(const SigningKey& key, Timestamp stored);

  // Appends the signature to a frame that announces one, and returns the signed frame. 'memory'
  // begins with the frame. 'unix_ns': the computer's clock.
  std::span<const std::uint8_t> Sign(std::span<const std::uint8_t> frame,
                                     std::span<std::uint8_t, kMaxFrame> memory,
                                     std::uint64_t unix_ns);

  enum class Verdict {
    kGood,
    kUnsigned,
    kForged,    // another key, or changed on the way
    kReplayed,  // not later than the last one of the same sender, or a minute behind this clock
  };
  Verdict Check(const Packet& packet, std::uint64_t unix_ns);

  // The latest timestamp: the next run has to begin after it.
  Timestamp timestamp() const { return timestamp_; }
  // Another program has signed with this key: new timestamps are later than its newest.
  void Continue(Timestamp newest) { timestamp_ = std::max(timestamp_, newest); }

 private:
  using Signature = std::array<std::uint8_t, 6>;
  struct Stream {
    std::uint8_t system = 0;
    std::uint8_t component = 0;
    std::uint8_t link = 0;
    Timestamp last = 0;
  };

  Signature SignatureOf(std::span<const std::uint8_t> signed_bytes) const;
  bool IsLater(const Packet& packet, std::uint8_t link, Timestamp timestamp);

  SigningKey key_;
  Timestamp timestamp_;
  std::array<Stream, 64> streams_;
  std::size_t stream_count_ = 0;
};

}  // namespace kestrel::mavlink
