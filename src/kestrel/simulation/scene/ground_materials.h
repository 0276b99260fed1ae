// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/simulation/scene/paint.h"

namespace kestrel {

// Material of the ground.
struct GroundMaterial {
  const char* name;
  Color color;
  double map_variation;     // variation of the reflectance at scales of decimetres and metres
  double detail_variation;  // variation of the reflectance at scales of millimetres and centimetres
  double grain_m;           // size of the smallest grains
  bool paved;               // roads are made of this material
};

// The last one is water, all others are land.
std::span<const GroundMaterial> GroundMaterials();

// Throws InputError for an unknown name.
const GroundMaterial& FindGroundMaterial(const std::string& name);

// CV_8UC1 codes around kDetailMean; opposite sides fit each other.
cv::Mat DetailOf(const GroundMaterial& material, int size_px, double size_m, std::uint64_t seed);

}  // namespace kestrel
