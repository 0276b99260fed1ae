// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/drawing.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

// The black ink of the landing pattern, ring and cross, rotated by 'yaw' (rad); in the pattern's
// frame P unless given otherwise.
Drawing LandingPatternInk(const LandingPattern& pattern, const Eigen::Vector2d& center = {0, 0},
                          double yaw = 0);

// A square around 'center' of a plane, rotated by 'yaw' (rad).
Drawing SquareBoard(const Eigen::Vector2d& center, double size_m, double yaw);

// Returns 'patches' small discs and scratches at random within 'radius_m' of 'center'.
std::vector<Drawing::Shape> WornPlaces(const Eigen::Vector2d& center, double radius_m, int patches,
                                       Random* random);

// Erases such places.
void WearInk(const Eigen::Vector2d& center, double radius_m, int patches, Random* random,
             Drawing* ink);

// A round, crossed or square figure that is not the landing pattern.
struct Lookalike {
  const char* name;
  // Draws its ink within 'radius' of 'center', rotated by 'yaw'; details are random.
  Drawing (*draw)(const Eigen::Vector2d& center, double radius, double yaw, Random* random);
};

enum class LookalikeSet {
  kPlain,             // figures that the eye distinguishes from the pattern at once
  kWithCounterfeits,  // also those that differ from it in one thing only
  kHeldOut,           // other kinds, which are never used for training
};
std::span<const Lookalike> Lookalikes(LookalikeSet set = LookalikeSet::kPlain);

}  // namespace kestrel
