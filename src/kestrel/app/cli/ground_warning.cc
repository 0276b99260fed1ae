// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/ground_warning.h"

#include <fmt/format.h>

#include "kestrel/vision/pipeline/ground_height.h"

namespace kestrel {

std::string GroundWarning(const HuntPipeline& pipeline, std::optional<double> altitude_m,
                          bool has_world) {
  const std::optional<GroundHeight> higher = pipeline.ground_contradiction();
  if (!higher) return "";
  if (!has_world) {
    return fmt::format(
        "by the size of the objects the camera is {0:.2f} m above the ground (standard deviation "
        "{1:.2f} m), --altitude says {2:g} m: set --altitude {0:.2f}",
        *altitude_m - higher->height_m, higher->sigma_m, *altitude_m);
  }
  const double ground_m = pipeline.options().ground_height_m;
  return fmt::format(
      "by the size of the objects the ground is at z = {0:.2f} m of the navigation's world "
      "(standard deviation {1:.2f} m), hunt.ground_height_m says {2:g} m: set "
      "hunt.ground_height_m={0:.2f}, or correct the navigation's z, its clock or the camera's "
      "mount",
      ground_m + higher->height_m, higher->sigma_m, ground_m);
}

}  // namespace kestrel
