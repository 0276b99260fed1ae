// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/camera_model.h"

namespace kestrel {

// A lens that zooms, or a camera that switches between lenses. Its setting is named by the
// horizontal field of view that the camera reports, which need not be exact.
struct ZoomLens {
  struct Setting {
    double view_rad = 0;  // as reported
    CameraIntrinsics lens;
  };
  std::vector<Setting> settings;  // calibrated, at least one, the narrowest view first
  Duration clock_offset{};        // t_nav = t_zoom + clock_offset
  int device_id = 0;              // MAVLink's camera_device_id; 0: the first one heard
};

// Returns the horizontal field of view (rad) of a lens without regard to its coefficients: that of
// an equidistant or a pinhole lens with this focal length.
double ViewOf(const CameraIntrinsics& lens);

// Returns the lens at a reported field of view: between two settings by interpolation (of the
// focal length by ratio), and around a single one by the ratio of the views. Nothing where the view
// is more than 5 % outside of the settings.
std::optional<CameraIntrinsics> LensAt(const ZoomLens& zoom, double view_rad);

}  // namespace kestrel
