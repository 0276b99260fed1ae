// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "kestrel/calibration/color_training/marked_pixels.h"
#include "kestrel/vision/objects/color/color_grid.h"
#include "kestrel/vision/objects/color/color_model.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// Returns the mixture of the marked pixels (ChooseColorMixture), changed to suit other frames:
// wider in value, as paint keeps its hue in other light but not its value; and narrower overall
// where that excludes a larger share of the other pixels than of the wanted ones. Throws InputError
// for fewer than ten wanted pixels.
ColorMixture TeachColor(const std::string& color, std::span<const FrameMarks> marks,
                        double max_distance);

// Replaces colours of a model by mixtures (ChooseColorMixture) of samples, which are given by the
// colour's name. Returns a line for people about each, and about what its samples lack. Throws
// InputError for a name that the model does not have, for too few samples, and when the new model
// is not valid or its colours cannot be distinguished.
std::vector<std::string> ReplaceColors(const std::map<std::string, std::vector<Hsv>>& samples,
                                       int components, ObjectModel* model);

// The overlap of two colours of a model; a pixel's colour is uncertain there.
struct ColorOverlap {
  std::string color;  // the other one
  double share = 0;   // share of this colour's cells in the grid
};

// Returns the overlaps of colour 'color' (an index) with the other colours of a valid 'model', in
// the model's order, without those that are zero.
std::vector<ColorOverlap> ColorOverlaps(const ColorModel& model, std::size_t color);

// Throws InputError when another colour of a valid 'model' has most of the cells of colour 'color'
// too: the grid then cannot distinguish the two, and gives one the pixels of the other.
void RequireDistinct(const ColorModel& model, std::size_t color);

// The quality of a model's colour, measured by the marked pixels.
struct ColorScores {
  // Recall in one frame when the colour is taught by the other frames only.
  struct LeftOut {
    std::size_t frame = 0;
    double recall = 0;
  };

  std::size_t wanted = 0;  // marked pixels of the colour
  double recall = 0;       // share of them that the grid labels so; 0 without any
  std::size_t others = 0;  // marked pixels of another colour or of none
  double false_share = 0;  // share of them that the grid gives this colour
  std::vector<ColorOverlap> overlaps;
  std::vector<LeftOut> left_outs;  // for frames with wanted pixels, if there are several
};

// Scores the colour 'color' (an index) of a valid 'model'; 'grid' is the grid of that model.
ColorScores ScoreColor(const ColorModel& model, const ColorGrid& grid, std::size_t color,
                       std::span<const FrameMarks> marks);

// Returns what should be marked differently, one sentence each: SampleWarnings, too few frames or
// lightings, no marks of what the colour is not.
std::vector<std::string> TeachingWarnings(std::span<const FrameMarks> marks);

}  // namespace kestrel
