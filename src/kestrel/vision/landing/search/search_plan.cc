// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/search/search_plan.h"

namespace kestrel {

const std::array<SearchPass, kSearchPasses> kPasses = {{
    {.image_level = 3, .tile_level = 5, .min_ring_px = 64, .max_ring_px = 1e9},
    {.image_level = 2, .tile_level = 4, .min_ring_px = 32, .max_ring_px = 400},
    {.image_level = 1, .tile_level = 3, .min_ring_px = 16, .max_ring_px = 200},
    {.image_level = 3, .tile_level = 5, .min_ring_px = 64, .max_ring_px = 1e9, .black = true},
    {.image_level = 2, .tile_level = 4, .min_ring_px = 32, .max_ring_px = 400, .black = true},
    {.image_level = 1, .tile_level = 3, .min_ring_px = 16, .max_ring_px = 200, .black = true},
    {.image_level = 0,
     .tile_level = 1,
     .min_ring_px = 6,
     .max_ring_px = 120,
     .top_hat = true,
     .narrow = true},
    {.image_level = 0, .tile_level = 2, .min_ring_px = 6, .max_ring_px = 120, .narrow = true},
    {.image_level = 0, .tile_level = 3, .min_ring_px = 6, .max_ring_px = 120, .not_bright = true},
}};

const std::array<SearchStep, kSearchSteps> kSteps = {{
    {1, SearchMethod::kAreas},
    {2, SearchMethod::kAreas},
    {0, SearchMethod::kArcs},
    {1, SearchMethod::kArcs},
    {2, SearchMethod::kArcs},
    {3, SearchMethod::kArcs},
    {4, SearchMethod::kArcs},
    {5, SearchMethod::kArcs},
    {0, SearchMethod::kCross},
    {6, SearchMethod::kAreas},
    {7, SearchMethod::kAreas},
    {8, SearchMethod::kAreas},
    {2, SearchMethod::kCutAreas},
    {6, SearchMethod::kCutAreas},
    {7, SearchMethod::kCutAreas},
    {6, SearchMethod::kArcs},
    {7, SearchMethod::kArcs},
}};

}  // namespace kestrel
