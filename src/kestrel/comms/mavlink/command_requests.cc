// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/command_requests.h"

#include <algorithm>

#include "kestrel/comms/mavlink/mavlink_enums.h"

namespace kestrel {

mavlink::CommandLong ModeCommand(AutopilotKind kind, std::uint32_t custom_mode, std::uint8_t system,
                                 std::uint8_t component) {
  constexpr std::uint32_t kByte = 0xff;
  const bool is_px4 = kind == AutopilotKind::kPx4;
  mavlink::CommandLong command;
  command.target_system = system;
  command.target_component = component;
  if (is_px4 && custom_mode == CustomModeOf(kind, FlightMode::kLand)) {
    command.command = mavlink::kCommandLand;
    return command;
  }
  command.command = mavlink::kCommandDoSetMode;
  command.param1 = mavlink::kModeFlagCustom;
  command.param2 = static_cast<float>(is_px4 ? custom_mode >> 16 & kByte : custom_mode);
  if (is_px4) command.param3 = static_cast<float>(custom_mode >> 24);
  return command;
}

bool IsModeCommand(std::uint16_t command) {
  return command == mavlink::kCommandDoSetMode || command == mavlink::kCommandLand;
}

bool CommandRequests::Ending::is_accepted() const { return result == mavlink::kResultAccepted; }

void CommandRequests::Want(const mavlink::CommandLong& command) {
  Drop(command.command);
  const auto slot = std::find(requests_.begin(), requests_.end(), std::nullopt);
  Request request;
  request.command = command;
  // There are fewer kinds of commands than slots.
  if (slot != requests_.end()) *slot = request;
}

void CommandRequests::Drop(std::uint16_t command) {
  for (auto& request : requests_) {
    if (request && request->command.command == command) request.reset();
  }
}

bool CommandRequests::IsWanted(std::uint16_t command) const {
  return std::any_of(requests_.begin(), requests_.end(), [&](const auto& request) {
    return request && request->command.command == command;
  });
}

std::optional<CommandRequests::Ending> CommandRequests::Handle(const mavlink::CommandAck& ack) {
  for (auto& request : requests_) {
    if (!request || request->command.command != ack.command || request->sent == 0) continue;
    if (ack.result == mavlink::kResultInProgress) {
      request->is_in_progress = true;
      return std::nullopt;
    }
    const Ending ending{request->command, ack.result};
    request.reset();
    return ending;
  }
  return std::nullopt;
}

std::optional<mavlink::CommandLong> CommandRequests::Next(Time now, std::optional<Ending>* ended) {
  constexpr int kMostSent = 6;
  constexpr Duration kPatience = std::chrono::milliseconds(300);
  constexpr Duration kProgressPatience = std::chrono::seconds(5);
  for (auto& request : requests_) {
    if (!request) continue;
    const Duration patience = request->is_in_progress ? kProgressPatience : kPatience;
    if (request->sent > 0 && now < request->sent_at + patience) continue;
    if (request->sent == kMostSent) {
      *ended = Ending{request->command, std::nullopt};
      request.reset();
      continue;
    }
    request->command.confirmation = static_cast<std::uint8_t>(request->sent++);
    request->sent_at = now;
    return request->command;
  }
  return std::nullopt;
}

const char* CommandResultName(std::uint8_t result) {
  switch (result) {
    case mavlink::kResultAccepted:
      return "accepted";
    case mavlink::kResultTemporarilyRejected:
      return "temporarily rejected";
    case mavlink::kResultDenied:
      return "denied";
    case mavlink::kResultUnsupported:
      return "not supported";
    case mavlink::kResultFailed:
      return "failed";
    case mavlink::kResultInProgress:
      return "in progress";
    default:
      return "refused";
  }
}

}  // namespace kestrel
