// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/app/ros_node/node_options.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/vision/objects/color_grid.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// What the hunt looks for.
struct HuntedObjects {
  ObjectModel model;
  ColorGrid grid;
};

// What the files say that the options name.
struct NodeFiles {
  std::optional<CameraCalibration> calibration;  // nothing: camera_info says it
  std::optional<HuntedObjects> objects;          // of the hunt; the built-in ones without files
};

// Throws InputError when one of them is at fault.
NodeFiles ReadNodeFiles(const NodeOptions& options);

}  // namespace kestrel
