// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "landing_variants.h"

namespace kestrel {

// What makes a print hard to see, as strong as the seed says: too little light, too much of it,
// dirt, shadows of thin things.
std::span<const ImageVariant> Hardships();

}  // namespace kestrel
