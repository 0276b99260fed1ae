// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/labelled_images/relief.h"

#include <cmath>
#include <numbers>

#include "kestrel/core/base/limits.h"

namespace kestrel {
namespace {

// Height of a folded sheet at a position across it, all -1 to 1: up at one third, down at the
// other.
double FoldProfile(double across) {
  constexpr double kCrease = 1.0 / 3;
  const double distance = std::abs(across);
  const double height = distance < kCrease ? distance / kCrease : (1 - distance) / (1 - kCrease);
  return across < 0 ? -height : height;
}

}  // namespace

double Relief::HeightAt(const Eigen::Vector2d& point) const {
  const double half = 0.5 * size_m;
  const double x = (point.x() + point.y()) / (std::numbers::sqrt2 * half);
  const double y = (point.y() - point.x()) / (std::numbers::sqrt2 * half);
  if (std::abs(x) >= 1 || std::abs(y) >= 1) return 0;
  return bulge_m * (1 - x * x) * (1 - y * y) + 0.5 * fold_m * (FoldProfile(x) + FoldProfile(y));
}

std::vector<std::string> Relief::Validate() const {
  std::vector<std::string> violations;
  Require(size_m, Range{1e-3, 1e3}, "size_m", &violations);
  constexpr double kSteepest = 0.2;  // share of the size
  Require(bulge_m, Range{-kSteepest * size_m, kSteepest * size_m}, "bulge_m", &violations);
  Require(fold_m, Range{-kSteepest * size_m, kSteepest * size_m}, "fold_m", &violations);
  return violations;
}

}  // namespace kestrel
