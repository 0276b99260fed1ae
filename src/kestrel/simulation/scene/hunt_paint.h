// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/paint.h"

namespace kestrel {

// Paint of an object of the hunt: 'color' is red, green, blue, yellow or orange; 'fading' (0 to 1)
// is the bleached part. It varies a little from object to object, and is dirty.
std::shared_ptr<const Texture> FadedPaint(double fading, const std::string& color, int channels,
                                          Random* random);

// The same with a white digit on it, which reads along the texture's x.
std::shared_ptr<const Texture> DigitPaint(double fading, const std::string& color, int digit,
                                          int channels, Random* random);

// Outline of an object that is not a disc: a triangle, square, star, ring, L, cross or stripes.
std::shared_ptr<const Texture> DistractorMask(Random* random);

}  // namespace kestrel
