// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kestrel/calibration/color_training/color_stroke.h"

namespace kestrel {

// What a person has marked so far, with a way back and forth.
class ColorDraft {
 public:
  static constexpr std::size_t kMaxStrokes = 500;

  // What was undone cannot be redone from then on. Throws InputError for a stroke that is not valid
  // and for one too many; the draft is then as it was.
  void Add(const ColorStroke& stroke);
  // False: there is nothing to undo, to redo.
  bool Undo();
  bool Redo();

  // In order; without those that were undone.
  std::span<const ColorStroke> strokes() const { return {strokes_.data(), count_}; }
  bool can_redo() const { return count_ < strokes_.size(); }

 private:
  std::vector<ColorStroke> strokes_;
  std::size_t count_ = 0;  // of those that are not undone
};

// YAML from which ParseColorDraft gets the same strokes. 'recording' says of what.
std::string PrintColorDraft(const ColorDraft& draft, const std::string& recording);
// Throws InputError, with the line, for what is missing, unknown, of the wrong type, or a draft of
// another recording. 'file' is for messages.
ColorDraft ParseColorDraft(const std::string& yaml, const std::string& recording,
                           const std::string& file);

}  // namespace kestrel
