// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "kestrel/calibration/color_training/color_stroke.h"

namespace kestrel {

enum class ColorAction {
  kChoose,  // the current colour
  kMark,    // mark pixels
  kUndo,    // undo a mark
  kRedo,
  kTeach,   // fit a colour's model to what is marked
  kRevert,  // go back to the model of the file
  kSave,    // save the model
  kKeep,    // keep the camera's newest image as a frame to be marked
};
// Returns "choose", "mark", "undo", "redo", "teach", "revert", "save" or "keep".
const char* ToString(ColorAction action);

// A request of the page of colours, as {"colors": "undo"}, {"colors": "teach", "color": "red"} or
// {"colors": "mark", "frame": 3, "color": "red", "tool": "brush", "size": 4, "points": [1, 2]}.
struct ColorRequest {
  ColorAction action = ColorAction::kUndo;
  std::string color = {};   // for kChoose and kTeach
  ColorStroke stroke = {};  // for kMark; valid
};

// Returns nothing unless the message is exactly one of those above; does not throw. Colours have at
// most 64 bytes; strokes pass ColorStroke::Validate.
std::optional<ColorRequest> ReadColorRequest(const nlohmann::json& message);

}  // namespace kestrel
