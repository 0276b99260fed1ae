// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kestrel/app/console/messages/color_request.h"

namespace kestrel {

// The browser has drawn the picture with this number and is ready for the next: {"ack": 7}.
struct ImageAck {
  std::uint64_t sequence = 0;
};

// The browser wants pictures: {"images": true}; none, as while the page is hidden: {"images":
// false}; a view by its name: {"images": "threshold 1/8"}; no frame other than the last: {"images":
// true, "hold": true}.
struct ImageWish {
  bool is_wanted = false;
  std::string view = {};  // empty: the camera's image; at most 64 bytes
  bool is_held = false;
};

// A command of the user: {"command": "record", "value": 1}.
enum class ConsoleCommandKind {
  kRecord,           // 1: start recording, 0: stop it
  kSnapshot,         // keep the present frame; no value
  kPlay,             // value: speed as a factor of real time; 0: hold, negative: backwards
  kSeek,             // value: seconds after the beginning
  kStep,             // value: number of frames forward
  kDetect,           // run the detector again with these settings
  kCancel,           // cancel this run
  kCalibrate,        // calibrate from the recording what the settings name
  kCalibrateCancel,  // cancel the calibration
  kCalibrateSave,    // save its result
  kCompare,          // compare the two variants of a study with these numbers
  kOpen,             // value: number of the row of a study's table to replay, from 0
  kLens,             // calibrate the lens of a live camera by a board and a distortion model
  kLensStop,         // stop that
  kLensSave,         // save its result: a name, and "replace" to replace a file
  kSettings,         // save these settings for the next start
  kMark,             // follow what is marked: the picture's time (ns), x, y, width, height (px)
  kPoint,            // point the gimbal again that was left to somebody else; no value
  kConfirm,          // the UAV may fly to what is marked
  kStop,             // it stands still
};
// Returns "record", "snapshot", "play", "seek", "step", "detect", "cancel", "calibrate",
// "calibrate-cancel", "calibrate-save", "compare", "open", "lens", "lens-stop", "lens-save",
// "settings", "mark", "point", "confirm" or "stop".
const char* ToString(ConsoleCommandKind kind);
struct ConsoleCommand {
  ConsoleCommandKind kind = ConsoleCommandKind::kSnapshot;
  double value = 0;  // finite
  // As in {"command": "detect", "settings": ["landing.still=true"]}, {"command": "calibrate",
  // "settings": ["mount", "clock"]} or {"command": "compare", "settings": ["0", "2"]}. At most 32
  // settings of at most 512 bytes each.
  std::vector<std::string> settings = {};
};

using ClientMessage = std::variant<ImageAck, ImageWish, ConsoleCommand, ColorRequest>;

// Parses a message of a browser. Returns nothing unless it is exactly one of the messages above.
// Does not throw.
std::optional<ClientMessage> ParseClientMessage(std::string_view text);

}  // namespace kestrel
