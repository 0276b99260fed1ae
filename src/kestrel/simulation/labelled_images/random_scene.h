// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/labelled_images/landing_stills.h"
#include "kestrel/simulation/labelled_images/scene_renderer.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

// Random parts of stills. All lengths are in metres on the scene's plane.

// Returns asphalt or grass under a sky, with up to four white lines.
Scene RandomGround(Random* random);

// Adds the landing pattern on its board, often on a vehicle's roof, sometimes worn.
void AddRandomPattern(const LandingPattern& pattern, Random* random, Scene* scene);

// Adds stains and scratches on a print of radius 'radius_m' around 'center'. 'wear': as in
// LandingStillOptions; 0 adds nothing and draws no random number.
void AddRandomWear(const Eigen::Vector2d& center, double radius_m, double wear, Random* random,
                   Scene* scene);

// Adds a look-alike of a random kind, on a board or painted on the ground; returns its name.
const char* AddRandomLookalike(const Eigen::Vector2d& center, double radius_m, LookalikeSet set,
                               Random* random, Scene* scene);

// Light of a condition on a region of radius 'radius_m' around 'center', and its conversion to gray
// values: shadows, highlights, haze, blur, noise, each up to the strength that the eye can still
// see through. 'shadow_reach_m': distance of mixed shadows from the origin. 'height_m': of the UAV.
// 'size_px': smallest width of the pattern in the image. 'shadow_caster': see LandingStillOptions.
struct StillLight {
  StillCondition condition;
  int shadow_caster;
  Eigen::Vector2d center;
  double radius_m;
  double shadow_reach_m;
  double height_m;
  double size_px;
};
void AddRandomShadows(const StillLight& light, Random* random, Scene* scene);
void AddRandomGlares(const StillLight& light, Random* random, Scene* scene);
ImagingOptions RandomImaging(const StillLight& light, Random* random);

}  // namespace kestrel
