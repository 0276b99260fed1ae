// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kestrel/calibration/color_training/marked_pixels.h"
#include "kestrel/vision/objects/color_grid.h"
#include "kestrel/vision/objects/color_model.h"

namespace kestrel {

// The mixture of the marked pixels (ChooseColorMixture), made useful for other frames than those:
// wider in value, as paint keeps its hue in other light but not its value, and in all narrower
// where that leaves out more of the other pixels than of the wanted ones. Throws InputError for
// fewer than ten wanted pixels.
ColorMixture TeachColor(const std::string& color, std::span<const FrameMarks> marks,
                        double max_distance);

// What two colours of a model have in common: which of them a pixel is depends on little there.
struct ColorOverlap {
  std::string color;  // the other one
  double share = 0;   // of this colour's cells in the grid
};

// Of the colour number 'color' of a valid 'model' with the others, of more than nothing, in the
// model's order.
std::vector<ColorOverlap> ColorOverlaps(const ColorModel& model, std::size_t color);

// Throws InputError when most of the cells of colour number 'color' of a valid 'model' are another
// one's too: the grid cannot tell the two apart, and gives the pixels of one to the other.
void RequireDistinct(const ColorModel& model, std::size_t color);

// How good a colour of a model is, by the marked pixels.
struct ColorScores {
  // Of a frame's pixels, when the colour is taught by the other frames only.
  struct LeftOut {
    std::size_t frame = 0;
    double recall = 0;
  };

  std::size_t wanted = 0;  // marked pixels of the colour
  double recall = 0;       // the part of them that the grid says so of; 0 when there are none
  std::size_t others = 0;  // marked pixels of another colour or of none
  double false_share = 0;  // the part of them that the grid says this colour of
  std::vector<ColorOverlap> overlaps;
  std::vector<LeftOut> left_outs;  // of frames with wanted pixels, when there are several
};

// Of the colour number 'color' of a valid 'model'; 'grid' is of that model.
ColorScores ScoreColor(const ColorModel& model, const ColorGrid& grid, std::size_t color,
                       std::span<const FrameMarks> marks);

// What should be marked otherwise, a sentence each: SampleWarnings, too few frames or lightings,
// nothing marked that the colour is not.
std::vector<std::string> TeachingWarnings(std::span<const FrameMarks> marks);

}  // namespace kestrel
