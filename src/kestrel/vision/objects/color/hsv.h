// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace kestrel {

// A colour: hue in degrees, 0 to 360 (a circle: red is at both ends), saturation and value 0 to 1.
struct Hsv {
  float hue_deg = 0;
  float saturation = 0;
  float value = 0;
};

// Converts 8-bit channels, which need not be integers. Gray has the hue 0.
inline Hsv HsvFromBgr(float b, float g, float r) {
  const float max = std::max({b, g, r});
  const float range = max - std::min({b, g, r});
  Hsv hsv{0, max > 0 ? range / max : 0, max / 255};
  if (range <= 0) return hsv;
  if (max == r) {
    hsv.hue_deg = 60 * (g - b) / range;
  } else if (max == g) {
    hsv.hue_deg = 120 + 60 * (b - r) / range;
  } else {
    hsv.hue_deg = 240 + 60 * (r - g) / range;
  }
  if (hsv.hue_deg < 0) hsv.hue_deg += 360;
  return hsv;
}

// Returns 'from' minus 'to' the shorter way around the circle, degrees, -180 to 180.
inline float HueDifference(float from, float to) { return std::remainder(from - to, 360.0F); }

}  // namespace kestrel
