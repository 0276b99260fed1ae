// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// Commands whose answer matters: each is sent until the autopilot answers it. The answer is no
// proof that it did it.
class CommandRequests {
 public:
  // How a command ended.
  struct Ending {
    mavlink::CommandLong command;
    std::optional<std::uint8_t> result;  // MAV_RESULT; nothing: it was never answered

    bool is_accepted() const;
  };

  // Sends this from now on, in the place of an earlier one of the same number.
  void Want(const mavlink::CommandLong& command);
  // No longer sends that one.
  void Drop(std::uint16_t command);
  // It is on its way.
  bool IsWanted(std::uint16_t command) const;

  // An answer; how the command that it answers ended, if it did.
  std::optional<Ending> Handle(const mavlink::CommandAck& ack);

  // The message to send at 'now'; nothing: none is due. 'ended' is set when the patience with one
  // is over.
  std::optional<mavlink::CommandLong> Next(Time now, std::optional<Ending>* ended);

 private:
  struct Request {
    mavlink::CommandLong command;
    int sent = 0;
    bool is_in_progress = false;
    Time due{};
  };
  static constexpr std::size_t kMost = 4;

  std::array<std::optional<Request>, kMost> requests_;
};

// MAV_RESULT in words: "denied", "temporarily rejected", ...
const char* CommandResultName(std::uint8_t result);

}  // namespace kestrel
