// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/base/random.h"
#include "kestrel/landing/landing_pattern.h"
#include "kestrel/stills/scene_renderer.h"

namespace kestrel {

// The random parts of which stills are made. All lengths in metres on the scene's plane.

// Asphalt or grass under a sky, with up to four white lines.
Scene RandomGround(Random* random);

// The landing pattern on its board, often on a vehicle's roof, sometimes worn.
void AddRandomPattern(const LandingPattern& pattern, Random* random, Scene* scene);

// A look-alike of a random kind, on a board or painted on the ground; returns its name.
const char* AddRandomLookalike(const Eigen::Vector2d& center, double radius_m,
                               bool with_counterfeits, Random* random, Scene* scene);

// In three of ten scenes a shadow within 'reach_m' of the origin: a hard edge or that of a UAV.
void AddRandomShadow(double reach_m, Random* random, Scene* scene);

// In one of ten scenes a mirrored sun that washes out a part of the pattern.
void AddRandomGlare(double radius_m, Random* random, Scene* scene);

// Light, haze, blur and noise for a pattern whose smallest width in the image is 'size_px'. The
// noise follows the contrast and the blur the size, so that an eye can still see the pattern.
ImagingOptions RandomImaging(double size_px, Random* random);

}  // namespace kestrel
