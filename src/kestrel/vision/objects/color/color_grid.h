// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "kestrel/vision/objects/color/color_model.h"

namespace kestrel {

// Label of a cell of the grid: 0 background, then 1, 2, ... for the colours in the model's order.
using ColorLabel = std::uint8_t;
inline constexpr ColorLabel kBackgroundLabel = 0;
// A pixel with this label joins a segment when the pixels around it belong to the segment.
inline constexpr ColorLabel kAmbiguousLabel = std::numeric_limits<ColorLabel>::max();

// A part of the hue-saturation plane, at every value. Hues run from 'min_hue_deg' upwards around
// the circle to 'max_hue_deg', both 0 to 360 (350 to 10 is red); saturations are 0 to 1.
struct HueSaturationRegion {
  double min_hue_deg = 0;
  double max_hue_deg = 360;
  double min_saturation = 0;
  double max_saturation = 1;

  bool Contains(const Hsv& color) const;
};

// The RGB cube in 64^3 cells with one label each (paper, section 3.2). Labelling a pixel takes one
// look-up, whatever the model.
class ColorGrid {
 public:
  static constexpr int kCellsPerChannel = 64;
  static constexpr std::size_t kCells =
      std::size_t{kCellsPerChannel} * kCellsPerChannel * kCellsPerChannel;  // 262,144

  ColorGrid() : labels_(kCells, kBackgroundLabel) {}  // all background
  explicit ColorGrid(const ColorModel& model);

  // Reads the bytes of a file: one per cell, red changing slowest and blue fastest, raw and without
  // a header. Save and the authors' programs write such files. Throws InputError when there are not
  // 262,144 bytes or one is neither ambiguous nor at most 'color_count'. 'file' is for messages.
  static ColorGrid Parse(const std::string& bytes, std::size_t color_count,
                         const std::string& file);
  static ColorGrid Load(const std::string& path, std::size_t color_count);
  // Replaces the file atomically. Throws InputError when it cannot be written.
  void Save(const std::string& path) const;

  ColorLabel At(std::uint8_t b, std::uint8_t g, std::uint8_t r) const {
    return labels_[(r >> 2) << 12 | (g >> 2) << 6 | b >> 2];
  }
  // Label of an 8-bit BGR pixel.
  ColorLabel At(const std::uint8_t* bgr) const { return At(bgr[0], bgr[1], bgr[2]); }

  // Labels all cells whose centre lies in the region. Returns their number.
  std::size_t SetRegion(const HueSaturationRegion& region, ColorLabel label);
  // Resets the cells in the region that have 'label' to background. Returns their number.
  std::size_t ClearRegion(const HueSaturationRegion& region, ColorLabel label);

  const std::vector<ColorLabel>& labels() const { return labels_; }
  // Colour at the middle of a cell.
  static Hsv CellColor(std::size_t cell);

 private:
  std::vector<ColorLabel> labels_;
};

}  // namespace kestrel
