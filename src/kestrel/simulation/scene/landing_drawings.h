// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/drawing.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

// The black ink of the landing pattern, ring and cross, turned by 'yaw' (rad); in its frame P
// unless said otherwise.
Drawing LandingPatternInk(const LandingPattern& pattern, const Eigen::Vector2d& center = {0, 0},
                          double yaw = 0);

// A square around the origin of a plane, turned by 'yaw' (rad).
Drawing SquareBoard(const Eigen::Vector2d& center, double size_m, double yaw);

// Erases up to 'patches' small discs and scratches somewhere within 'radius_m' of 'center'.
void WearInk(const Eigen::Vector2d& center, double radius_m, int patches, Random* random,
             Drawing* ink);

// Something round, crossed or square that is not the landing pattern.
struct Lookalike {
  const char* name;
  // Its ink, within 'radius' of 'center' and turned by 'yaw'; details are random.
  Drawing (*draw)(const Eigen::Vector2d& center, double radius, double yaw, Random* random);
};

enum class LookalikeSet {
  kPlain,             // what an eye can tell from the pattern at once
  kWithCounterfeits,  // those too that differ from it in one thing only
  kHeldOut,           // other kinds, which nothing is trained on
};
std::span<const Lookalike> Lookalikes(LookalikeSet set = LookalikeSet::kPlain);

}  // namespace kestrel
