// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/ground_materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {
namespace {

const std::array<GroundMaterial, 5>& Materials() {
  static const std::array<GroundMaterial, 5> materials = {
      GroundMaterial{"asphalt", {0.135, 0.13, 0.128}, 0.16, 0.28, 0.006, true},
      GroundMaterial{"concrete", {0.27, 0.29, 0.3}, 0.12, 0.12, 0.01, true},
      GroundMaterial{"sand", {0.16, 0.24, 0.31}, 0.14, 0.16, 0.008, false},
      GroundMaterial{"grass", {0.045, 0.12, 0.085}, 0.28, 0.55, 0.009, false},
      GroundMaterial{"water", {0.07, 0.055, 0.03}, 0.25, 0.5, 0.03, false},
  };
  return materials;
}

}  // namespace

std::span<const GroundMaterial> GroundMaterials() { return Materials(); }

const GroundMaterial& FindGroundMaterial(const std::string& name) {
  for (const GroundMaterial& material : Materials()) {
    if (name == material.name) return material;
  }
  std::vector<std::string> names;
  for (const GroundMaterial& material : Materials()) names.emplace_back(material.name);
  throw InputError(
      fmt::format("material is '{}', expected one of {}", name, fmt::join(names, ", ")));
}

cv::Mat DetailOf(const GroundMaterial& material, int size_px, double size_m, std::uint64_t seed) {
  constexpr double kRatio = 2.3;
  constexpr int kOctaves = 4;
  const double grain_px = std::max(material.grain_m * size_px / size_m, 1.0);
  const double largest_px = grain_px * std::pow(kRatio, kOctaves - 1);
  const cv::Mat noise = FractalNoise({size_px, size_px}, largest_px, kOctaves, kRatio, seed);
  cv::Mat codes(noise.size(), CV_8UC1);
  for (int v = 0; v < codes.rows; ++v) {
    for (int u = 0; u < codes.cols; ++u) {
      const double factor = 1 + material.detail_variation * noise.at<float>(v, u);
      codes.at<std::uint8_t>(v, u) = CodeOfReflectance(kDetailMean * std::max(factor, 0.1));
    }
  }
  return codes;
}

}  // namespace kestrel
