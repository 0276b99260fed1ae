// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/LU>

#include "kestrel/core/image/thinning.h"
#include "kestrel/vision/landing/verification/cross.h"

namespace kestrel {
namespace {

constexpr int kBins = 36;   // bins of the histogram of directions, over a right angle
constexpr int kFewest = 8;  // pixels in the direction of the arms
// Inner radii: the two lines are not separate nearer to the middle, and the disc ends.
constexpr double kNearRadius = 0.15;
constexpr double kFarRadius = 0.85;
constexpr int kThinnings = 20;       // more than the widest arm needs
constexpr double kOffArm = 0.35;     // tangent; pixels farther from an arm's direction are not its
constexpr double kLeastSeen = 0.35;  // of a half arm, to be asked for
constexpr double kMaxSkew = 20 * std::numbers::pi / 180;  // of the arms from a right angle
constexpr double kMaxOffCenter = 1.0 / 3;                 // inner radii: a sixth of the diameter

// Line through the points of one arm and its opposite, by total least squares.
struct ArmLine {
  int count = 0;
  int on_side[2] = {0, 0};  // points on either side of the centre
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0;

  void Add(double px, double py, bool side) {
    ++count;
    ++on_side[side ? 1 : 0];
    x += px;
    y += py;
    xx += px * px;
    xy += px * py;
    yy += py * py;
  }
  Eigen::Vector2d mean() const { return {x / count, y / count}; }
  double angle() const {
    const Eigen::Vector2d m = mean();
    return 0.5 * std::atan2(2 * (xy / count - m.x() * m.y()),
                            xx / count - m.x() * m.x() - (yy / count - m.y() * m.y()));
  }
};

// Returns the direction, modulo a right angle, in which most pixels lie as seen from the centre.
std::optional<double> DominantDirection(const RingInside& inside, const SmallMask& lines) {
  std::array<int, kBins> histogram{};
  for (int y = 0; y < lines.size(); ++y) {
    for (std::uint64_t row = lines.row(y); row != 0; row &= row - 1) {
      const double u = inside.Coordinate(std::countr_zero(row));
      const double v = inside.Coordinate(y);
      if (u * u + v * v < kNearRadius * kNearRadius) continue;
      const double turn = std::atan2(v, u) / (0.5 * std::numbers::pi) + 2;
      ++histogram[static_cast<int>((turn - std::floor(turn)) * kBins) % kBins];
    }
  }
  int best = 0, best_count = 0;
  for (int i = 0; i < kBins; ++i) {
    int count = 0;
    for (int j = -2; j <= 2; ++j) count += histogram[(i + j + kBins) % kBins];
    if (count > best_count) {
      best = i;
      best_count = count;
    }
  }
  if (best_count < kFewest) return std::nullopt;
  return (best + 0.5) / kBins * 0.5 * std::numbers::pi;
}

// Returns the share of a half arm that is in view, 0 to 1.
double HalfArmSeen(const RingInside& inside, double angle) {
  constexpr int kSamples = 10;
  int seen = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double radius = kNearRadius + (kFarRadius - kNearRadius) * i / (kSamples - 1);
    const auto index = [&](double coordinate) {
      return static_cast<int>((radius * coordinate + 1) * 0.5 * inside.disc.size());
    };
    seen += inside.disc.at(index(std::cos(angle)), index(std::sin(angle)));
  }
  return static_cast<double>(seen) / kSamples;
}

}  // namespace

std::optional<Cross> FindCrossByThinning(const RingInside& inside) {
  SmallMask lines = inside.dark;
  ThinGuoHall(&lines, kThinnings);
  const std::optional<double> direction = DominantDirection(inside, lines);
  if (!direction) return std::nullopt;
  const double cosine = std::cos(*direction);
  const double sine = std::sin(*direction);
  std::array<ArmLine, 2> arms;
  for (int y = 0; y < lines.size(); ++y) {
    for (std::uint64_t row = lines.row(y); row != 0; row &= row - 1) {
      const double u = inside.Coordinate(std::countr_zero(row));
      const double v = inside.Coordinate(y);
      const double along = cosine * u + sine * v;
      const double across = cosine * v - sine * u;
      if (u * u + v * v < kNearRadius * kNearRadius) continue;
      if (std::abs(across) < kOffArm * std::abs(along)) arms[0].Add(u, v, along > 0);
      if (std::abs(along) < kOffArm * std::abs(across)) arms[1].Add(u, v, across > 0);
    }
  }
  // A half arm that the image shows leaves about 0.6 inner radii of pixels.
  const double full = std::max(3.0, lines.size() / 8.0);
  std::array<int, 2> sides{};  // per arm, number of half arms in view
  for (int arm = 0; arm < 2; ++arm) {
    for (int side = 0; side < 2; ++side) {
      const double seen =
          HalfArmSeen(inside, *direction + (arm + (side == 0 ? 2 : 0)) * 0.5 * std::numbers::pi);
      if (seen < kLeastSeen) continue;
      if (arms[arm].on_side[side] < seen * full) return std::nullopt;
      ++sides[arm];
    }
  }
  if (sides[0] + sides[1] == 0) return std::nullopt;
  if (sides[0] == 0) return Cross{arms[1].angle()};
  if (sides[1] == 0) return Cross{arms[0].angle()};
  const double a0 = arms[0].angle();
  const double a1 = arms[1].angle();
  const double cross_sine = std::sin(a1 - a0);
  if (std::abs(cross_sine) < std::cos(kMaxSkew)) return std::nullopt;
  Eigen::Matrix2d directions;
  directions << std::cos(a0), -std::cos(a1), std::sin(a0), -std::sin(a1);
  const Eigen::Vector2d lengths = directions.inverse() * (arms[1].mean() - arms[0].mean());
  const Eigen::Vector2d crossing =
      arms[0].mean() + lengths(0) * Eigen::Vector2d(std::cos(a0), std::sin(a0));
  if (crossing.norm() > kMaxOffCenter) return std::nullopt;
  const double c4 = std::cos(4 * a0) + std::cos(4 * a1);
  const double s4 = std::sin(4 * a0) + std::sin(4 * a1);
  return Cross{std::atan2(s4, c4) / 4};
}

}  // namespace kestrel
