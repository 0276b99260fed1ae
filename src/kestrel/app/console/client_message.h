// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kestrel/app/console/color_request.h"

namespace kestrel {

// "The picture with this number is drawn, send the next": {"ack": 7}.
struct ImageAck {
  std::uint64_t sequence = 0;
};

// "Pictures, please", or none, as while the page is not in view: {"images": true}; of a view by its
// name: {"images": "threshold 1/8"}; of no other frame than the last: {"images": true, "hold":
// true}.
struct ImageWish {
  bool is_wanted = false;
  std::string view = {};  // empty: the camera's image; at most 64 bytes
  bool is_held = false;
};

// What the user asks for: {"command": "record", "value": 1}.
enum class ConsoleCommandKind {
  kRecord,           // 1: start, 0: stop recording
  kSnapshot,         // keep the present frame; no value
  kPlay,             // at so many times the speed, 0: hold, negative: backwards
  kSeek,             // to so many s after the beginning
  kStep,             // so many frames forward
  kDetect,           // again with these settings
  kCancel,           // that
  kCalibrate,        // from the recording what the settings say
  kCalibrateCancel,  // that
  kCalibrateSave,    // what it came to
};
// "record", "snapshot", "play", "seek", "step", "detect", "cancel", "calibrate",
// "calibrate-cancel", "calibrate-save"
const char* ToString(ConsoleCommandKind kind);
struct ConsoleCommand {
  ConsoleCommandKind kind = ConsoleCommandKind::kSnapshot;
  double value = 0;  // finite
  // As {"command": "detect", "settings": ["landing.still=true"]} or {"command": "calibrate",
  // "settings": ["mount", "clock"]}: at most 32 of 128 bytes each.
  std::vector<std::string> settings = {};
};

using ClientMessage = std::variant<ImageAck, ImageWish, ConsoleCommand, ColorRequest>;

// What a browser has sent; nothing when it is not one of those above, to the letter. Does not
// throw.
std::optional<ClientMessage> ParseClientMessage(std::string_view text);

}  // namespace kestrel
