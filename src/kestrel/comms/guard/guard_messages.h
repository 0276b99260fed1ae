// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <sys/socket.h>
#include <sys/types.h>

#include "kestrel/comms/guard/flight_guard.h"
#include "kestrel/comms/mavlink/autopilot_kind.h"

// The datagrams between the program that flies and its guard, over a SOCK_SEQPACKET of one
// computer. The first byte is the kind.
namespace kestrel {

enum class GuardMessage : std::uint8_t {
  // To the guard.
  kLife = 'L',     // a GuardLife
  kGoodbye = 'G',  // the program ends in order
  // To the program.
  kWaits = 'W',      // the guard of an earlier flight still works on this line
  kReady = 'R',      // the line is open
  kFailed = 'X',     // it cannot be opened: the reason in words
  kAnswer = 'A',     // to a sign of life: a byte, whether the line is connected, and its open_error
  kTakenOver = 'T',  // the program was taken for dead
  // Both ways.
  kBytes = 'M',  // bytes of the serial line
};

// A sign of life: what is to be done if it is the last one, and what is needed for that.
struct GuardLife {
  GuardTask task = GuardTask::kNothing;
  AutopilotKind kind = AutopilotKind::kUnknown;
  std::uint8_t autopilot_system = 0;
  std::uint8_t autopilot_component = 0;
  std::uint8_t system = 0;  // ids of the program
  std::uint8_t component = 0;
  std::uint64_t signing_timestamp = 0;  // the newest
  std::int64_t sent_ns = 0;             // now, on the clock of Now()
};

// Returns the sign of life in a datagram without its kind; nothing when it is none.
inline std::optional<GuardLife> ReadLife(std::span<const std::uint8_t> bytes) {
  GuardLife life;
  if (bytes.size() != sizeof(life)) return std::nullopt;
  std::memcpy(&life, bytes.data(), sizeof(life));
  if (life.task > GuardTask::kLand || life.kind < AutopilotKind::kUnknown ||
      life.kind > AutopilotKind::kOther) {
    return std::nullopt;
  }
  return life;
}

// Sends a datagram; false when it does not fit into the system's buffer, or the other end is gone.
inline bool SendTo(int file, GuardMessage kind, std::span<const std::uint8_t> bytes = {}) {
  iovec parts[] = {{&kind, sizeof(kind)}, {const_cast<std::uint8_t*>(bytes.data()), bytes.size()}};
  msghdr message{};
  message.msg_iov = parts;
  message.msg_iovlen = 2;
  return sendmsg(file, &message, MSG_DONTWAIT | MSG_NOSIGNAL) >= 0;
}

struct ReceivedDatagram {
  bool is_end = false;                  // the other end is gone
  std::optional<GuardMessage> kind;     // nothing: no datagram waits
  std::span<const std::uint8_t> bytes;  // in the buffer given
};

inline ReceivedDatagram ReceiveFrom(int file, std::span<std::uint8_t> buffer) {
  GuardMessage kind{};
  iovec parts[] = {{&kind, sizeof(kind)}, {buffer.data(), buffer.size()}};
  msghdr message{};
  message.msg_iov = parts;
  message.msg_iovlen = 2;
  const ssize_t size = recvmsg(file, &message, MSG_DONTWAIT);
  if (size > 0) return {false, kind, buffer.first(static_cast<std::size_t>(size) - 1)};
  return {size == 0 || (errno != EAGAIN && errno != EINTR), std::nullopt, {}};
}

}  // namespace kestrel
