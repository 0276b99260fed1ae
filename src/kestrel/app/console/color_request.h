// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "kestrel/calibration/color_training/color_stroke.h"

namespace kestrel {

enum class ColorAction {
  kChoose,  // the colour that is looked at
  kMark,    // pixels
  kUndo,    // of marking
  kRedo,
  kTeach,   // a colour by what is marked
  kRevert,  // to the model of the file
  kSave,    // the model
  kKeep,    // the camera's newest image, as a frame to be marked
};
// "choose", "mark", "undo", "redo", "teach", "revert", "save", "keep"
const char* ToString(ColorAction action);

// What the page of colours asks for, as {"colors": "undo"}, {"colors": "teach", "color": "red"} or
// {"colors": "mark", "frame": 3, "color": "red", "tool": "brush", "size": 4, "points": [1, 2]}.
struct ColorRequest {
  ColorAction action = ColorAction::kUndo;
  std::string color = {};   // to choose or teach
  ColorStroke stroke = {};  // valid, to mark
};

// Nothing when it is none of those above, to the letter; does not throw. Colours have at most 64
// bytes, strokes what ColorStroke::Validate lets pass.
std::optional<ColorRequest> ReadColorRequest(const nlohmann::json& message);

}  // namespace kestrel
