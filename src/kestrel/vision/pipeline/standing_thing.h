// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace kestrel {

// Distance from the middle of the image of a thing down to its foot, the middle of what it stands
// on; across the line of sight.
struct FootBelow {
  double mean_m = 0;
  double sigma_m = 0;
};

// Returns where something of an unknown kind stands. 'across_m' and 'down_m' (positive): size of
// its image, level and across that, in metres across the line of sight, if it is on the ground.
// 'depression_rad': of the line of sight, 0 to pi/2. A box of length l, width w and height h that
// is seen from the side a appears as high as (l |cos a| + w |sin a|) sin(depression) + h
// cos(depression), and its foot is h cos(depression) / 2 below the middle of that. The mean is over
// people, riders, cars, trucks, boats and cubes from all sides, each as much as it fits the size.
FootBelow EstimateFoot(double across_m, double down_m, double depression_rad);

}  // namespace kestrel
