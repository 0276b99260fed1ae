// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"

namespace kestrel {

// The messages that an autopilot sends periodically, and their rates.
class MessageStreams {
 public:
  // Default streams: ArduPilot only heartbeats, PX4 those of its onboard mode; those of a gimbal
  // where it has one.
  explicit MessageStreams(AutopilotFirmware firmware, bool has_gimbal = false,
                          bool has_zoom = false, bool has_range = false);

  // As MAV_CMD_SET_MESSAGE_INTERVAL: 'interval_us' -1 stops it, 0 is the default. Returns
  // MAV_RESULT.
  std::uint8_t SetInterval(std::uint32_t id, double interval_us);

  // True when it can send that message.
  bool Has(std::uint32_t id) const;

  // Calls 'send' with the id of each message that is due by the autopilot's own clock.
  template <class Send>
  void SendDue(std::int64_t own_us, Send&& send) {
    for (Stream& stream : streams_) {
      if (stream.interval_us <= 0) continue;
      // After a reboot or a jump the clock may be far from the due times.
      const std::int64_t until = stream.due_us - own_us;
      if (until > stream.interval_us || until < -kLate_us) stream.due_us = own_us;
      if (stream.due_us > own_us) continue;
      stream.due_us += stream.interval_us;
      send(stream.id);
    }
  }

 private:
  static constexpr std::int64_t kLate_us = 500'000;

  struct Stream {
    std::uint32_t id;
    std::int64_t default_us;  // 0: not sent by default
    std::int64_t interval_us;
    std::int64_t due_us = 0;
  };

  AutopilotFirmware firmware_;
  std::vector<Stream> streams_;
};

}  // namespace kestrel
