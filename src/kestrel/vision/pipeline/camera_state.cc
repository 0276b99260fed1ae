// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/camera_state.h"

#include <fmt/format.h>

namespace kestrel {

std::string InWords(const CameraState& state) {
  switch (state.health) {
    case CameraHealth::kGood:
      return "is used again";
    case CameraHealth::kSilent:
      return "sends no images: left out until it does";
    case CameraHealth::kFrozen:
      return "repeats its image: left out until that changes";
    case CameraHealth::kContradicts:
      return fmt::format(
          "sees the target {:.2f} m from where the others see it: left out until it agrees; check "
          "its "
          "mount and its clock (kestrel calibrate mount --both)",
          state.offset_m);
    case CameraHealth::kAlone:
      return fmt::format(
          "is used although it saw the target {:.2f} m from where the others did: no other camera "
          "sees it",
          state.offset_m);
  }
  return "";
}

}  // namespace kestrel
