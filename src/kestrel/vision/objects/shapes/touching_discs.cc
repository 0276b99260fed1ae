// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/shapes/touching_discs.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>

namespace kestrel {
namespace {

constexpr std::size_t kMaxDiscs = 8;
// Distance of the centres of neighbours, in radii. In a blurred image discs that are slightly apart
// seem to touch, and the gap between them is filled.
constexpr double kMinSpacing = 1.6;
constexpr double kMaxSpacing = 2.3;

struct Discs {
  std::array<Eigen::Vector2d, kMaxDiscs> centers;
  std::size_t count = 0;
  double radius = 0;

  std::size_t Nearest(const Eigen::Vector2d& point) const {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < count; ++i) {
      if ((point - centers[i]).squaredNorm() < (point - centers[nearest]).squaredNorm()) {
        nearest = i;
      }
    }
    return nearest;
  }
};

double DepthOf(const Eigen::Vector2d& point, std::span<const Eigen::Vector2d> border) {
  double squared = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& at : border) squared = std::min(squared, (at - point).squaredNorm());
  return std::sqrt(squared);
}

// Returns the deepest points that are far enough from each other and about equally deep.
Discs FindCenters(std::span<const Eigen::Vector2d> inside,
                  std::span<const Eigen::Vector2d> border) {
  constexpr double kMinDepth = 0.7;  // in radii, near a centre; larger than in a neck
  std::array<double, 2 * kTouchingDiscsPoints> depths;
  const std::size_t size = std::min(inside.size(), depths.size());
  for (std::size_t i = 0; i < size; ++i) depths[i] = DepthOf(inside[i], border);
  Discs discs;
  while (discs.count < kMaxDiscs) {
    const auto deepest = std::max_element(depths.begin(), depths.begin() + size);
    if (discs.count == 0) discs.radius = *deepest;
    if (!(*deepest > kMinDepth * discs.radius)) break;
    const Eigen::Vector2d& center = inside[deepest - depths.begin()];
    discs.centers[discs.count++] = center;
    for (std::size_t i = 0; i < size; ++i) {
      if ((inside[i] - center).norm() < 0.9 * kMinSpacing * discs.radius) depths[i] = 0;
    }
  }
  return discs;
}

// Fits the centres and the radius to the border (one Gauss-Newton step).
void Refine(std::span<const Eigen::Vector2d> border, Discs* discs) {
  constexpr double kBorderReach = 0.25;  // border points farther from a circle do not belong to it
  std::array<Eigen::Matrix2d, kMaxDiscs> normal;
  std::array<Eigen::Vector2d, kMaxDiscs> right;
  normal.fill(1e-9 * Eigen::Matrix2d::Identity());
  right.fill(Eigen::Vector2d::Zero());
  double sum = 0;
  double count = 0;
  for (const Eigen::Vector2d& point : border) {
    const std::size_t i = discs->Nearest(point);
    const Eigen::Vector2d offset = point - discs->centers[i];
    const double distance = offset.norm();
    const double residual = distance - discs->radius;
    if (std::abs(residual) > kBorderReach * discs->radius) continue;
    const Eigen::Vector2d outward = offset / distance;
    normal[i] += outward * outward.transpose();
    right[i] += residual * outward;
    sum += residual;
    ++count;
  }
  if (count == 0) return;
  for (std::size_t i = 0; i < discs->count; ++i) {
    discs->centers[i] += normal[i].inverse() * right[i];
  }
  discs->radius += sum / count;
}

// True when the border lies on the circles and covers enough of each, all around the others.
bool IsBorderOf(const Discs& discs, std::span<const Eigen::Vector2d> border, double pixel) {
  constexpr double kTolerance = 0.05;
  constexpr double kMinShare = 0.96;
  constexpr std::size_t kSectors = 16;
  constexpr double kMinSeen = 0.3;  // least visible share of a disc with three others around it
  std::array<std::bitset<kSectors>, kMaxDiscs> seen;
  double fitting = 0;
  for (const Eigen::Vector2d& point : border) {
    const std::size_t i = discs.Nearest(point);
    const Eigen::Vector2d offset = point - discs.centers[i];
    if (std::abs(offset.norm() - discs.radius) > kTolerance * discs.radius + pixel) continue;
    ++fitting;
    const double turn = std::atan2(offset.y(), offset.x()) / (2 * std::numbers::pi) + 0.5;
    seen[i].set(std::min(kSectors - 1, static_cast<std::size_t>(turn * kSectors)));
  }
  if (fitting < kMinShare * static_cast<double>(border.size())) return false;
  for (std::size_t i = 0; i < discs.count; ++i) {
    if (static_cast<double>(seen[i].count()) < kMinSeen * kSectors) return false;
  }
  return true;
}

// True when the figure is narrow between each disc and its nearest neighbour.
bool AreNeighbors(const Discs& discs, std::span<const Eigen::Vector2d> border, double pixel) {
  constexpr double kMaxNeck = 0.6;
  for (std::size_t i = 0; i < discs.count; ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    Eigen::Vector2d between = discs.centers[i];
    for (std::size_t k = 0; k < discs.count; ++k) {
      const double distance = (discs.centers[i] - discs.centers[k]).norm();
      if (k == i || distance >= nearest) continue;
      nearest = distance;
      between = 0.5 * (discs.centers[i] + discs.centers[k]);
    }
    if (nearest < kMinSpacing * discs.radius || nearest > kMaxSpacing * discs.radius ||
        DepthOf(between, border) > kMaxNeck * discs.radius + 0.5 * pixel) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::optional<double> RadiusOfTouchingDiscs(std::span<const Eigen::Vector2d> inside,
                                            std::span<const Eigen::Vector2d> border, double pixel) {
  constexpr double kMinRadius_px = 4;  // below this a disc looks like a square
  constexpr int kRounds = 5;
  if (inside.empty() || border.empty()) return std::nullopt;
  Discs discs = FindCenters(inside, border);
  if (discs.count < 2) return std::nullopt;
  for (int round = 0; round < kRounds; ++round) Refine(border, &discs);
  if (!(discs.radius >= kMinRadius_px * pixel) || !AreNeighbors(discs, border, pixel) ||
      !IsBorderOf(discs, border, pixel)) {
    return std::nullopt;
  }
  return discs.radius;
}

}  // namespace kestrel
