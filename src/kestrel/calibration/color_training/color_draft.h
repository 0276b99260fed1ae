// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kestrel/calibration/color_training/color_stroke.h"

namespace kestrel {

// The strokes that a person has marked so far, with undo and redo.
class ColorDraft {
 public:
  static constexpr std::size_t kMaxStrokes = 500;

  // Adds a stroke; undone strokes cannot be redone any more. Throws InputError for a stroke that is
  // not valid and when there are too many; the draft is then unchanged.
  void Add(const ColorStroke& stroke);
  // Return false when there is nothing to undo or to redo.
  bool Undo();
  bool Redo();

  // The strokes in order, without those that were undone.
  std::span<const ColorStroke> strokes() const { return {strokes_.data(), count_}; }
  bool can_redo() const { return count_ < strokes_.size(); }

 private:
  std::vector<ColorStroke> strokes_;
  std::size_t count_ = 0;  // strokes that are not undone
};

// Returns YAML for ParseColorDraft. 'recording': name of the recording that the strokes belong to.
std::string PrintColorDraft(const ColorDraft& draft, const std::string& recording);
// Throws InputError with the line for entries that are missing, unknown or of the wrong type, and
// for a draft of another recording. 'file' is for messages.
ColorDraft ParseColorDraft(const std::string& yaml, const std::string& recording,
                           const std::string& file);

}  // namespace kestrel
