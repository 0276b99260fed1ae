// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "kestrel/vision/landing/verification/cross.h"

namespace kestrel {
namespace {

constexpr double kLeastArea = 0.04;    // of a quadrant, share of the disc
constexpr double kMaxAreaRatio = 2.5;  // of the largest quadrant to the smallest
constexpr double kRightAngled = 0.6;   // least resultant of the directions, modulo a right angle

// Dilates by the neighbourhood of a pixel: itself and the four that share an edge with it.
void Dilate(SmallMask* mask) {
  std::uint64_t above = 0;
  for (int y = 0; y < mask->size(); ++y) {
    const std::uint64_t here = mask->row(y);
    mask->SetRow(y, here | here << 1 | here >> 1 | above | mask->row(y + 1));
    above = here;
  }
}

// Erodes by the same neighbourhood. Pixels outside of the mask count as set.
void Erode(SmallMask* mask) {
  const std::uint64_t columns = mask->columns();
  std::uint64_t above = columns;
  for (int y = 0; y < mask->size(); ++y) {
    const std::uint64_t here = mask->row(y);
    const std::uint64_t below = y + 1 < mask->size() ? mask->row(y + 1) : columns;
    const std::uint64_t left = here << 1 | 1;
    const std::uint64_t right = here >> 1 | (columns & ~(columns >> 1));
    mask->SetRow(y, here & left & right & above & below);
    above = here;
  }
}

struct Area {
  int pixels = 0;
  double x = 0;  // sums, then mean, in inner radii
  double y = 0;
};

// Returns the 4-connected area around a pixel and clears it in 'mask'.
Area TakeArea(const RingInside& inside, int x, int y, SmallMask* mask) {
  std::array<std::pair<std::int8_t, std::int8_t>, SmallMask::kMaxSize * SmallMask::kMaxSize> stack;
  std::size_t depth = 0;
  const auto push = [&](int px, int py) {
    if (!mask->at(px, py)) return;
    mask->Clear(px, py);
    stack[depth++] = {static_cast<std::int8_t>(px), static_cast<std::int8_t>(py)};
  };
  Area area;
  push(x, y);
  while (depth > 0) {
    const auto [px, py] = stack[--depth];
    ++area.pixels;
    area.x += inside.Coordinate(px);
    area.y += inside.Coordinate(py);
    push(px + 1, py);
    push(px - 1, py);
    push(px, py + 1);
    push(px, py - 1);
  }
  area.x /= area.pixels;
  area.y /= area.pixels;
  return area;
}

}  // namespace

std::optional<Cross> FindCrossByQuadrants(const RingInside& inside) {
  SmallMask closed = inside.dark;
  Dilate(&closed);
  Erode(&closed);
  SmallMask bright(closed.size());
  int disc_pixels = 0;
  for (int y = 0; y < closed.size(); ++y) {
    bright.SetRow(y, inside.disc.row(y) & ~closed.row(y));
    disc_pixels += std::popcount(inside.disc.row(y));
  }
  std::array<Area, 4> quadrants;
  int count = 0;
  for (int y = 0; y < bright.size(); ++y) {
    while (bright.row(y) != 0) {
      const Area area = TakeArea(inside, std::countr_zero(bright.row(y)), y, &bright);
      if (area.pixels < kLeastArea * disc_pixels) continue;
      if (count == 4) return std::nullopt;
      quadrants[count++] = area;
    }
  }
  if (count < 4) return std::nullopt;
  const auto [smallest, largest] =
      std::minmax_element(quadrants.begin(), quadrants.end(),
                          [](const Area& a, const Area& b) { return a.pixels < b.pixels; });
  if (largest->pixels > kMaxAreaRatio * smallest->pixels) return std::nullopt;

  // The quadrants lie between the arms: the mean of their directions, modulo a right angle.
  double cosine = 0, sine = 0;
  for (const Area& area : quadrants) {
    const double angle = std::atan2(area.y, area.x);
    cosine += std::cos(4 * angle) / 4;
    sine += std::sin(4 * angle) / 4;
  }
  if (std::hypot(cosine, sine) < kRightAngled) return std::nullopt;
  return Cross{std::atan2(sine, cosine) / 4 + std::numbers::pi / 4};
}

}  // namespace kestrel
