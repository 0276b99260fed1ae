// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// The command that requests a mode (HEARTBEAT.custom_mode) of an autopilot with these ids. LAND is
// requested from PX4 by NAV_LAND: DO_SET_MODE is refused without a position, and NAV_LAND never is.
mavlink::CommandLong ModeCommand(AutopilotKind kind, std::uint32_t custom_mode, std::uint8_t system,
                                 std::uint8_t component);

// True for the commands of ModeCommand.
bool IsModeCommand(std::uint16_t command);

// Commands whose answer matters: each is repeated until the autopilot answers it. The answer does
// not prove that the command was carried out.
class CommandRequests {
 public:
  // The outcome of a command.
  struct Ending {
    mavlink::CommandLong command;
    std::optional<std::uint8_t> result;  // MAV_RESULT; nothing: no answer ever came

    bool is_accepted() const;
  };

  // Sends this command from now on, in place of an earlier one of the same number.
  void Want(const mavlink::CommandLong& command);
  // Stops sending that command.
  void Drop(std::uint16_t command);
  // True while the command is being sent.
  bool IsWanted(std::uint16_t command) const;

  // Takes an answer. Returns the outcome of the command that it answers, if that has ended.
  std::optional<Ending> Handle(const mavlink::CommandAck& ack);

  // Returns the message to send at 'now'; nothing when none is due. Sets 'ended' when a command is
  // given up.
  std::optional<mavlink::CommandLong> Next(Time now, std::optional<Ending>* ended);

 private:
  struct Request {
    mavlink::CommandLong command;
    int sent = 0;
    bool is_in_progress = false;
    Time sent_at{};
  };
  static constexpr std::size_t kMost = 4;

  std::array<std::optional<Request>, kMost> requests_;
};

// MAV_RESULT in words: "denied", "temporarily rejected", ...
const char* CommandResultName(std::uint8_t result);

}  // namespace kestrel
