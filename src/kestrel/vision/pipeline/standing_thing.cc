// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/standing_thing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

struct Box {
  double length_m, width_m, height_m;
};
// The height is that of the ends: the roof of a car does not change where its image begins.
constexpr std::array<Box, 7> kThings = {{{0.3, 0.5, 1.75},   // person
                                         {1.7, 0.6, 1.7},    // rider
                                         {4.5, 1.8, 1.1},    // car
                                         {7.0, 2.4, 2.6},    // truck
                                         {5.5, 2.0, 0.9},    // boat
                                         {1.0, 1.0, 1.0},    // anything else,
                                         {0.4, 0.4, 0.4}}};  // and small
constexpr int kSides = 8;                                    // in a quarter turn
// Standard deviation of the sizes of one kind, and of the box around it in the image, of the
// logarithm.
constexpr double kSpread = 0.25;
// Weight of what does not fit: something may be of none of these kinds.
constexpr double kLeastWeight = 0.01;

double Square(double x) { return x * x; }

}  // namespace

FootBelow EstimateFoot(double across_m, double down_m, double depression_rad) {
  const double sine = std::sin(depression_rad), cosine = std::cos(depression_rad);
  double weights = 0, mean = 0, square = 0;
  for (const Box& thing : kThings) {
    for (int i = 0; i < kSides; ++i) {
      const double side = (i + 0.5) / kSides * kPi / 2;
      const double deep_m = thing.length_m * std::cos(side) + thing.width_m * std::sin(side);
      const double wide_m = thing.length_m * std::sin(side) + thing.width_m * std::cos(side);
      const double high_m = deep_m * sine + thing.height_m * cosine;
      const double misfit = Square(std::log(across_m / wide_m)) + Square(std::log(down_m / high_m));
      const double weight = kLeastWeight + std::exp(-0.5 * misfit / Square(kSpread));
      const double share = 0.5 * thing.height_m * cosine / high_m;
      const double variance = 2 * Square(kSpread * share * (1 - 2 * share));
      weights += weight;
      mean += weight * share;
      square += weight * (Square(share) + variance);
    }
  }
  mean /= weights;
  const double variance = std::max(square / weights - Square(mean), 0.0);
  return {down_m * mean, down_m * std::sqrt(variance)};
}

}  // namespace kestrel
