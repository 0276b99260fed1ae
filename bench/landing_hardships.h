// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "landing_variants.h"

namespace kestrel {

// Returns changes that make a print hard to see, with strengths that depend on the seed: too little
// light, too much light, dirt, shadows of thin things.
std::span<const ImageVariant> Hardships();

}  // namespace kestrel
