// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/console/client_message.h"

#include <array>
#include <cmath>
#include <string>

#include <nlohmann/json.hpp>

namespace kestrel {
namespace {

using Json = nlohmann::json;

constexpr std::array kCommands = {ConsoleCommandKind::kRecord, ConsoleCommandKind::kSnapshot,
                                  ConsoleCommandKind::kPlay, ConsoleCommandKind::kSeek,
                                  ConsoleCommandKind::kStep};
// Nothing that is asked for is nested; deeper text would cost the stack of the parser.
constexpr int kMaxDepth = 2;

std::optional<ClientMessage> ReadCommand(const Json& message) {
  const Json& name = message["command"];
  if (!name.is_string()) return std::nullopt;
  ConsoleCommand command;
  if (message.contains("value")) {
    if (!message["value"].is_number()) return std::nullopt;
    command.value = message["value"].get<double>();
  }
  if (!std::isfinite(command.value)) return std::nullopt;
  if (message.size() != (message.contains("value") ? 2 : 1)) return std::nullopt;
  for (const ConsoleCommandKind kind : kCommands) {
    if (name.get_ref<const std::string&>() != ToString(kind)) continue;
    command.kind = kind;
    return command;
  }
  return std::nullopt;
}

}  // namespace

const char* ToString(ConsoleCommandKind kind) {
  switch (kind) {
    case ConsoleCommandKind::kRecord:
      return "record";
    case ConsoleCommandKind::kSnapshot:
      return "snapshot";
    case ConsoleCommandKind::kPlay:
      return "play";
    case ConsoleCommandKind::kSeek:
      return "seek";
    case ConsoleCommandKind::kStep:
      return "step";
  }
  return "";
}

std::optional<ClientMessage> ParseClientMessage(std::string_view text) {
  bool is_too_deep = false;
  const auto limit_depth = [&](int depth, Json::parse_event_t, Json&) {
    is_too_deep |= depth > kMaxDepth;
    return depth <= kMaxDepth;
  };
  const Json message = Json::parse(text, limit_depth, /*allow_exceptions=*/false);
  if (is_too_deep || !message.is_object()) return std::nullopt;
  if (message.contains("command")) return ReadCommand(message);
  if (message.size() != 1) return std::nullopt;
  const auto field = message.begin();
  if (field.key() == "ack" && field->is_number_unsigned()) {
    return ImageAck{field->get<std::uint64_t>()};
  }
  if (field.key() == "images" && field->is_boolean()) return ImageWish{field->get<bool>()};
  return std::nullopt;
}

}  // namespace kestrel
