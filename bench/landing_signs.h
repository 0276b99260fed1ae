// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/labelled_images/scene_renderer.h"
#include "landing_frames.h"

namespace kestrel {

// Part of a sign by which the eye tells it from the landing pattern.
struct Mark {
  std::vector<Eigen::Vector2d> points;  // in the sign's plane, m
  double least_share = 0.5;             // of the points that must be in view
};

// A sign as large as the landing pattern.
struct Sign {
  Drawing ink;
  std::vector<Mark> marks;  // any one of them is enough
};

struct SignKind {
  const char* name;
  Sign (*draw)(Random* random);
  bool is_pattern = false;
  bool is_held_out = false;  // nothing is trained or tuned on it
};
// Returns the pattern itself, then signs that are not it.
std::span<const SignKind> SignKinds();

enum class SignLight { kFull, kShadow, kGlare };
inline constexpr int kSignLights = 3;

// Gray value of white paper; above 255 the board saturates.
inline constexpr std::array<double, 4> kSignWhites{330, 242, 180, 60};

// Renders a sign on its board in one light, at all exposures in turn: frames of the pattern, or of
// something else. 'cut_off': by the border of the image, the tell in view.
std::vector<LandingFrame> RenderSign(const SignKind& kind, SignLight light, bool cut_off,
                                     std::uint64_t seed);

}  // namespace kestrel
