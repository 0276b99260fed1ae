// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kestrel/calibration/color_training/color_teaching.h"
#include "kestrel/vision/objects/color_model.h"

namespace kestrel {

// What the page of colours shows beside pictures and scores.
struct ConsoleColors {
  // Another one when the marks or the model have changed, and with them the pictures.
  std::uint64_t revision = 0;
  std::size_t frames = 0;           // of the recording, or that are kept
  std::size_t most_kept = 0;        // of a live camera's frames; 0: of a recording
  std::vector<std::string> names;   // of the colours, in the order of their labels, from 1
  std::string color;                // that is looked at
  std::vector<std::size_t> marked;  // frames, in order
  std::size_t strokes = 0;
  bool can_redo = false;
  // Of the colour that is looked at: what is marked so, and its mixture.
  std::vector<std::uint32_t> histogram;  // of HueSaturationHistogram, row by row
  double cut_hue_deg = 0;                // where its strip of hues begins
  std::vector<ColorComponent> components;
  double max_distance = 3;  // at which a component ends, standard deviations
  std::vector<std::string> warnings;
  std::vector<std::string> difference;  // of the model to the file's, in lines
  std::string file;                     // that the model is saved as
  std::vector<std::string> versions;    // of it that are kept, the newest last
  std::string answer;                   // to the last request, in words
  bool is_refused = false;              // that request
};

// They take longer than the rest.
struct ConsoleColorScores {
  std::uint64_t revision = 0;  // of the ConsoleColors that they belong to
  std::string color;
  ColorScores scores;
};

}  // namespace kestrel
