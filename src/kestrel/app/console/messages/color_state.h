// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kestrel/calibration/color_training/color_teaching.h"
#include "kestrel/vision/objects/color/color_model.h"

namespace kestrel {

// State of the page of colours, without pictures and scores.
struct ConsoleColors {
  // Changes whenever the marks or the model change, and with them the pictures.
  std::uint64_t revision = 0;
  std::size_t frames = 0;     // number of frames of the recording, or of kept frames
  std::size_t most_kept = 0;  // greatest number of kept frames of a live camera; 0 for a recording
  std::vector<std::string> names;   // names of the colours in the order of their labels, from 1
  std::string color;                // the current colour
  std::vector<std::size_t> marked;  // indices of the marked frames, in order
  std::size_t strokes = 0;
  bool can_redo = false;
  // For the current colour: histogram of its marks, and its mixture.
  std::vector<std::uint32_t> histogram;  // HueSaturationHistogram, row by row
  double cut_hue_deg = 0;                // where its strip of hues begins
  std::vector<ColorComponent> components;
  double max_distance = 3;  // limit of a component, standard deviations
  std::vector<std::string> warnings;
  std::vector<std::string> difference;  // lines in which the model differs from the file
  std::string file;                     // file that the model is saved to
  std::vector<std::string> versions;    // kept versions of the model, the newest last
  std::string answer;                   // answer to the last request, in words
  bool is_refused = false;              // the last request was refused
};

// Scores of a colour. They come later than the state because they take longer.
struct ConsoleColorScores {
  std::uint64_t revision = 0;  // revision of the ConsoleColors that they belong to
  std::string color;
  ColorScores scores;
};

}  // namespace kestrel
