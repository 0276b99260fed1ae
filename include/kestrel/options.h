// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Options from YAML files and from "key=value" text, printed with their units and meanings, and
// checked.
//
// Example:
//   LandingPatternDetectorOptions options;
//   ReadOptions("detector.yaml", &options);
//   SetOption("pattern.outer_diameter_m=0.6", &options);
//   RequireValid(options);
//   std::cout << PrintOptions(options);

#include "kestrel/core/base/options.h"  // IWYU pragma: export
