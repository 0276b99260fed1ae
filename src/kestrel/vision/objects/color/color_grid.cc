// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/color/color_grid.h"

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/write_file.h"

namespace kestrel {

bool HueSaturationRegion::Contains(const Hsv& color) const {
  if (color.saturation < min_saturation || color.saturation > max_saturation) return false;
  const double hue = color.hue_deg;
  if (min_hue_deg <= max_hue_deg) return hue >= min_hue_deg && hue <= max_hue_deg;
  return hue >= min_hue_deg || hue <= max_hue_deg;
}

ColorGrid::ColorGrid(const ColorModel& model) : ColorGrid() {
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    const Hsv color = CellColor(cell);
    if (const auto index = model.Classify(color)) {
      labels_[cell] = static_cast<ColorLabel>(*index + 1);
    } else if (model.ambiguous.Mahalanobis(color) <= model.max_distance) {
      labels_[cell] = kAmbiguousLabel;
    }
  }
}

ColorGrid ColorGrid::Parse(const std::string& bytes, std::size_t color_count,
                           const std::string& file) {
  if (bytes.size() != kCells) {
    throw InputError(
        fmt::format("{}: has {} bytes, a color grid has {}", file, bytes.size(), kCells));
  }
  ColorGrid grid;
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    const auto label = static_cast<ColorLabel>(bytes[cell]);
    if (label > color_count && label != kAmbiguousLabel) {
      throw InputError(fmt::format("{}: byte {} is {}, expected 0 to {} or {}", file, cell, label,
                                   color_count, kAmbiguousLabel));
    }
    grid.labels_[cell] = label;
  }
  return grid;
}

ColorGrid ColorGrid::Load(const std::string& path, std::size_t color_count) {
  return Parse(ReadFile(path), color_count, path);
}

void ColorGrid::Save(const std::string& path) const {
  WriteFile(path, std::string(labels_.begin(), labels_.end()));
}

std::size_t ColorGrid::SetRegion(const HueSaturationRegion& region, ColorLabel label) {
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    if (!region.Contains(CellColor(cell))) continue;
    labels_[cell] = label;
    ++count;
  }
  return count;
}

std::size_t ColorGrid::ClearRegion(const HueSaturationRegion& region, ColorLabel label) {
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    if (labels_[cell] != label || !region.Contains(CellColor(cell))) continue;
    labels_[cell] = kBackgroundLabel;
    ++count;
  }
  return count;
}

Hsv ColorGrid::CellColor(std::size_t cell) {
  constexpr std::size_t kSide = kCellsPerChannel;
  const auto middle = [width = 256.0F / kSide](std::size_t index) {
    return width * static_cast<float>(index) + 0.5F * (width - 1);
  };
  return HsvFromBgr(middle(cell % kSide), middle(cell / kSide % kSide),
                    middle(cell / (kSide * kSide)));
}

}  // namespace kestrel
