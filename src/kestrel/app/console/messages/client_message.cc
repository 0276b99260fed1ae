// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/messages/client_message.h"

#include <array>
#include <cmath>
#include <string>

#include <nlohmann/json.hpp>

namespace kestrel {
namespace {

using Json = nlohmann::json;

constexpr std::array kCommands = {ConsoleCommandKind::kRecord,
                                  ConsoleCommandKind::kSnapshot,
                                  ConsoleCommandKind::kPlay,
                                  ConsoleCommandKind::kSeek,
                                  ConsoleCommandKind::kStep,
                                  ConsoleCommandKind::kDetect,
                                  ConsoleCommandKind::kCancel,
                                  ConsoleCommandKind::kCalibrate,
                                  ConsoleCommandKind::kCalibrateCancel,
                                  ConsoleCommandKind::kCalibrateSave,
                                  ConsoleCommandKind::kCompare,
                                  ConsoleCommandKind::kOpen,
                                  ConsoleCommandKind::kLens,
                                  ConsoleCommandKind::kLensStop,
                                  ConsoleCommandKind::kLensSave,
                                  ConsoleCommandKind::kSettings,
                                  ConsoleCommandKind::kMark,
                                  ConsoleCommandKind::kPoint,
                                  ConsoleCommandKind::kConfirm,
                                  ConsoleCommandKind::kStop};
// A list in an object. Deeper text would use up the parser's stack.
constexpr int kMaxDepth = 2;
// True for the commands with a list of settings.
bool HasSettings(ConsoleCommandKind kind) {
  return kind == ConsoleCommandKind::kDetect || kind == ConsoleCommandKind::kCalibrate ||
         kind == ConsoleCommandKind::kCompare || kind == ConsoleCommandKind::kLens ||
         kind == ConsoleCommandKind::kLensSave || kind == ConsoleCommandKind::kSettings ||
         kind == ConsoleCommandKind::kMark;
}
constexpr std::size_t kMaxSettings = 32, kMaxSettingBytes = 512;

bool ReadSettings(const Json& list, std::vector<std::string>* settings) {
  if (!list.is_array() || list.size() > kMaxSettings) return false;
  for (const Json& setting : list) {
    if (!setting.is_string()) return false;
    settings->push_back(setting.get<std::string>());
    if (settings->back().size() > kMaxSettingBytes) return false;
  }
  return true;
}

std::optional<ClientMessage> ReadImageWish(const Json& message) {
  constexpr std::size_t kMaxViewBytes = 64;
  ImageWish wish;
  const Json& images = message["images"];
  if (images.is_boolean()) {
    wish.is_wanted = images.get<bool>();
  } else if (images.is_string()) {
    wish.is_wanted = true;
    wish.view = images.get<std::string>();
    if (wish.view.size() > kMaxViewBytes) return std::nullopt;
  } else {
    return std::nullopt;
  }
  const auto hold = message.find("hold");
  if (message.size() != (hold == message.end() ? 1U : 2U)) return std::nullopt;
  if (hold == message.end()) return wish;
  if (!hold->is_boolean()) return std::nullopt;
  wish.is_held = hold->get<bool>();
  return wish;
}

std::optional<ClientMessage> ReadCommand(const Json& message) {
  const Json& name = message["command"];
  if (!name.is_string()) return std::nullopt;
  ConsoleCommand command;
  if (message.contains("value")) {
    if (!message["value"].is_number()) return std::nullopt;
    command.value = message["value"].get<double>();
  }
  if (!std::isfinite(command.value)) return std::nullopt;
  const bool has_settings = message.contains("settings");
  if (has_settings && !ReadSettings(message["settings"], &command.settings)) return std::nullopt;
  if (message.size() != 1 + message.count("value") + message.count("settings")) {
    return std::nullopt;
  }
  for (const ConsoleCommandKind kind : kCommands) {
    if (name.get_ref<const std::string&>() != ToString(kind)) continue;
    command.kind = kind;
    if (has_settings != HasSettings(kind)) return std::nullopt;
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
    case ConsoleCommandKind::kDetect:
      return "detect";
    case ConsoleCommandKind::kCancel:
      return "cancel";
    case ConsoleCommandKind::kCalibrate:
      return "calibrate";
    case ConsoleCommandKind::kCalibrateCancel:
      return "calibrate-cancel";
    case ConsoleCommandKind::kCalibrateSave:
      return "calibrate-save";
    case ConsoleCommandKind::kCompare:
      return "compare";
    case ConsoleCommandKind::kOpen:
      return "open";
    case ConsoleCommandKind::kLens:
      return "lens";
    case ConsoleCommandKind::kLensStop:
      return "lens-stop";
    case ConsoleCommandKind::kLensSave:
      return "lens-save";
    case ConsoleCommandKind::kSettings:
      return "settings";
    case ConsoleCommandKind::kMark:
      return "mark";
    case ConsoleCommandKind::kPoint:
      return "point";
    case ConsoleCommandKind::kConfirm:
      return "confirm";
    case ConsoleCommandKind::kStop:
      return "stop";
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
  if (message.contains("colors")) return ReadColorRequest(message);
  if (message.contains("images")) return ReadImageWish(message);
  if (message.size() != 1) return std::nullopt;
  const auto field = message.begin();
  if (field.key() == "ack" && field->is_number_unsigned()) {
    return ImageAck{field->get<std::uint64_t>()};
  }
  return std::nullopt;
}

}  // namespace kestrel
