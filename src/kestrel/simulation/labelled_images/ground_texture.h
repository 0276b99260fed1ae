// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace kestrel {

// Random brightness of the ground at all scales from centimetres to metres, like asphalt or grass:
// a sum of octaves of value noise on random lattices.
class GroundTexture {
 public:
  explicit GroundTexture(std::uint64_t seed);

  // Returns about -1 to 1, mean 0, at a point of the plane (m). Scales that a footprint of
  // 'footprint_m' cannot resolve are left out, because a camera averages over them.
  double At(const Eigen::Vector2d& point, double footprint_m) const;

 private:
  double Lattice(const Eigen::Vector2d& point) const;

  std::vector<float> lattice_;
};

}  // namespace kestrel
