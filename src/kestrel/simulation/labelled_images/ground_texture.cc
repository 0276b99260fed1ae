// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/labelled_images/ground_texture.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

constexpr int kLatticeBits = 7;
constexpr int kLatticeSize = 1 << kLatticeBits;
constexpr int kOctaves = 6;
constexpr double kLargestScale = 5.0;  // m
constexpr double kScaleRatio = 2.9;    // not an integer, so that lattices do not coincide

double SmoothStep(double t) { return t * t * (3 - 2 * t); }

}  // namespace

GroundTexture::GroundTexture(std::uint64_t seed) : lattice_(kLatticeSize * kLatticeSize) {
  Random random(seed);
  for (float& value : lattice_) value = static_cast<float>(random.Uniform(-1, 1));
}

double GroundTexture::At(const Eigen::Vector2d& point, double footprint_m) const {
  static const Eigen::Matrix2d kTurn = Eigen::Rotation2Dd(0.6).toRotationMatrix();
  double sum = 0;
  double scale = kLargestScale;
  Eigen::Vector2d turned = point;
  for (int octave = 0; octave < kOctaves && scale > footprint_m; ++octave) {
    const double weight = std::min(1.0, scale / footprint_m - 1);
    sum += weight * Lattice(turned / scale + Eigen::Vector2d::Constant(17.3 * octave));
    scale /= kScaleRatio;
    turned = kTurn * turned;
  }
  return sum * 0.6;
}

double GroundTexture::Lattice(const Eigen::Vector2d& point) const {
  constexpr int kMask = kLatticeSize - 1;
  const double column = std::floor(point.x());
  const double row = std::floor(point.y());
  const int left = static_cast<int>(static_cast<std::int64_t>(column) & kMask);
  const int right = (left + 1) & kMask;
  const int top = static_cast<int>(static_cast<std::int64_t>(row) & kMask) << kLatticeBits;
  const int bottom = (top + kLatticeSize) & (kLatticeSize * kLatticeSize - 1);
  const double x = SmoothStep(point.x() - column);
  const double y = SmoothStep(point.y() - row);
  const float* upper = lattice_.data() + top;
  const float* lower = lattice_.data() + bottom;
  const double above = upper[left] + x * (upper[right] - upper[left]);
  const double below = lower[left] + x * (lower[right] - lower[left]);
  return above + y * (below - above);
}

}  // namespace kestrel
