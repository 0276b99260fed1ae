// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/silence.h"

#include <cerrno>
#include <cstdint>
#include <system_error>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/link_url.h"
#include "kestrel/core/base/device_fault.h"

namespace kestrel {

std::string WhySilent(const Connection& connection) {
  constexpr std::uint64_t kRubbish = 50;  // bytes: more than a line that begins in mid-packet
  const LinkUrl url = ParseLinkUrl(connection.url());
  const ConnectionCounters counters = connection.counters();
  const int error = connection.open_error();
  const bool is_serial = IsSerial(url.scheme);
  const std::string line = is_serial ? url.place : url.text;
  if (error == ECONNREFUSED) return line + " refused: does the other end run, is its port right?";
  if (error != 0 && is_serial) return DeviceFault(line, error);
  if (error != 0) {
    return fmt::format("{} cannot be opened: {}", line, std::generic_category().message(error));
  }
  if (counters.unsigned_packets > 0) {
    return fmt::format("packets on {} are not signed, and refused: the autopilot has no key", line);
  }
  if (counters.forged_packets > 0) {
    return fmt::format("packets on {} are signed by another key, and refused", line);
  }
  if (counters.received > 0)
    return fmt::format("MAVLink on {}, but no autopilot's heartbeat", line);
  if (counters.garbage_bytes + counters.bad_checksums > kRubbish) {
    return is_serial
               ? fmt::format("bytes on {}, but no MAVLink: is its baud rate {}?", line, url.number)
               : fmt::format("bytes on {}, but no MAVLink", line);
  }
  return "nothing received on " + line;
}

}  // namespace kestrel
